"""The simulator as a co-simulation unit of the Functional Mock-up Interface."""
