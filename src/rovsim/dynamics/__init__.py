"""The equation of motion: body, actuation, effects, compiled engine, learned residuals."""
