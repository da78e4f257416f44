"""LCM in Python: messages, the transition stream, and programs that monitor the channels."""
