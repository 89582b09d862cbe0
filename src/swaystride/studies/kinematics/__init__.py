"""Error-state Kalman filter for the joint angles of runners (dissertation, chapter 4)."""
