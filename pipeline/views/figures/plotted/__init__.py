"""The numbers that a picture shows, taken from its axes: for the CSV file below it and for values under the pointer."""
