"""Laws that are sums of products of states at the same instant.

variables     the factors that terms may be made of
targets       what a term may act on: an axis, a direction in the tank, the water
library       all candidate terms, and the wrench of each
columns       how each term would show in the innovations
search        proposes the next term by sparse regression
selection     adds terms one by one, each refitted with all else
as_effect     a law as an effect of a hypothesis
wording       a law in LaTeX and in words
kernel_lines  writes a law as lines of Python
products      the form of these laws
"""
