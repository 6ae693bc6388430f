"""What was recorded: campaigns, readers of raw exports, signals. Knows no dynamics."""
