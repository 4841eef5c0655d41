"""How an answer is judged: criteria, rates with confidence intervals, the table of a result."""
