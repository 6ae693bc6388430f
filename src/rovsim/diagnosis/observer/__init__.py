"""TODO observer."""
