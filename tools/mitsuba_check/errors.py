"""What ends a comparison early: each becomes one sentence on stderr."""


class CheckError(Exception):
    """Not a mistake of this program: a file that cannot be exported, another program that is missing or failed."""
