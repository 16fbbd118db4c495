"""What ends a farm with one sentence."""


class FarmError(Exception):
    """code: the exit code, as glim's: 1 bad input, 2 usage, 3 device."""

    def __init__(self, sentence, code=1):
        super().__init__(sentence)
        self.code = code
