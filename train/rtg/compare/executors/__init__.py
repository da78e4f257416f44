"""Executors: where the jobs of a comparison run, on this machine or on others."""
