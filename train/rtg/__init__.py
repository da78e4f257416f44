"""Reverse trajectory generation: processes, learning and tools around the C++ core."""
