"""Environments of a task: a single one, a vector of them, and a curriculum of starts."""
