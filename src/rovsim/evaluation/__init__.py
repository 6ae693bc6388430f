"""How far model and measurement are apart: scores, ladder, budget, conditions of error."""
