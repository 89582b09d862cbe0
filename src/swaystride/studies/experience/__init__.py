"""Running kinematics and positive experience (dissertation, chapter 5)."""
