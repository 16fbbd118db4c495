"""What ends a study early: each becomes one sentence on stderr."""


class StudyError(Exception):
    """Not a mistake of this program: a scene that is missing, a run of glim that failed."""
