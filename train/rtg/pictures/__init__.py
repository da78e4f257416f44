"""Pictures of a run: drawings of its states and plots of its figures."""
