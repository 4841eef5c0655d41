"""What can be said of a case before it is computed: a first look."""
