"""Models driven by commands: replay, one step at a time, and a synthetic tank."""
