"""Messages with advice that no row provokes, and why; and statements that look like advice and are none."""

EXCEPTIONS = {}
NO_ADVICE = []
