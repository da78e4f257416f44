"""Child processes: a single one, the process graph, and stop signals."""
