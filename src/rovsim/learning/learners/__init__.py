"""The learners of residuals: one file each, found by looking into this folder.

A file declares `LEARNER` (`rovsim.learning.learner.Learner`) and nothing else is registered; its
defaults stand in `conf/residual/`. What several of them use lies in `rovsim.learning`.
"""
