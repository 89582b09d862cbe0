"""Balance training with concurrent or terminal visual feedback (dissertation, chapter 2)."""
