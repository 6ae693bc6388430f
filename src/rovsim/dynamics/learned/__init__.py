"""A trained residual inside the loop: its features, its kernels, its file. Trains nothing."""
