"""TODO learned."""
