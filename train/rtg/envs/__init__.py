"""The task as environments: one, many at once, and a curriculum of starts."""
