"""Learned residuals: what is left of the acceleration once physics has had its say."""
