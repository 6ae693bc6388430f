"""How fast it is, and whether physics hidden in a tank is found."""
