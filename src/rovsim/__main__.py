"""`python -m rovsim`: the command line."""

from rovsim.apps.cli.main import main

if __name__ == "__main__":
    main()
