"""Laws that are sums of products of what acts at the same instant.

variables     of what terms may be made
targets       on what they act
library       all terms, and the wrench of each
columns       how each would show
search        which comes next
selection     one after the other, each refitted with all else
as_effect     a law as an effect of a hypothesis
wording       a law in LaTeX and in words
kernel_lines  a law as lines of Python
products      the form of such laws
"""
