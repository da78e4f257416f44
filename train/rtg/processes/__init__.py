"""Child processes: one, the graph of them, and signals that end them."""
