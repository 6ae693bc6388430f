"""From poses on a camera clock to velocities and accelerations."""
