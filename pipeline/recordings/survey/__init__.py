"""What files of measurements hold, before any case says what it means."""
