"""LCM in Python: messages, the stream of transitions, and programs that watch the channels."""
