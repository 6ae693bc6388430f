"""Write the catalogue page: what each effect is, and what it looks like where a model lacks it.

`make catalogue` writes docs/catalogue.md and a picture per effect, the same every time.
"""
