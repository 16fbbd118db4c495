"""What ends a study early: each becomes one sentence on stderr."""


class StudyError(Exception):
    """The world's mistake: a scene that is missing, a run of glim that failed."""
