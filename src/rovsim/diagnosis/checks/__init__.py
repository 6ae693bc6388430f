"""What is asked of an answer: is structure left, is a name stretched, which values are known."""
