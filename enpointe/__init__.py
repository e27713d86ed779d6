"""A virtual ballet dancer that obeys gravity."""
