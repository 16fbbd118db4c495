"""What ends a comparison early: each becomes one sentence on stderr."""


class CheckError(Exception):
    """The world's mistake: a file that cannot be exported, a program that is missing or failed."""
