"""What can be said of a case before it is computed: a first look, and how much work it is."""
