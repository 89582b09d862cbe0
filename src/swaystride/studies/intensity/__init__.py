"""Balance exercise intensity: therapist ratings, self-ratings and sway (dissertation, chapter 3)."""
