"""The page in the browser: a robot in its passage, live or recorded."""
