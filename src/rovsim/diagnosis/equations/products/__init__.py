"""Laws that are sums of products of what acts at the same instant."""
