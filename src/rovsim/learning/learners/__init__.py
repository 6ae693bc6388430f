"""The learners of residuals, one file each; every file in this folder is found.

A file declares `LEARNER` (`rovsim.learning.learner.Learner`); it need not be registered anywhere.
Its defaults are in `conf/residual/`. What several learners use is in `rovsim.learning`.
"""
