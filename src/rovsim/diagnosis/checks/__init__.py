"""What is asked of an answer: is structure left, is a name imitation, what is known."""
