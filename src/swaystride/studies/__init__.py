"""The studies: each reads like the methods section of its paper."""
