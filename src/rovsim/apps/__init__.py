"""Ways in: command line, workbench, Gymnasium, FMI."""
