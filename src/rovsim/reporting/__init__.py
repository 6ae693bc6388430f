"""What is shown: figures, tables, pages, the catalogue. Decides nothing, computes no physics."""
