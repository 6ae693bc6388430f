"""Each run held out once: folds, others' published errors beside ours, pitfalls repeated."""
