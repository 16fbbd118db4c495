"""What ends a farm: one sentence, or a signal."""

import signal


def stop_signals():
    """SIGINT, SIGTERM and, unless it is ignored (nohup), SIGHUP."""
    hang_up = [signal.SIGHUP] if signal.getsignal(signal.SIGHUP) != signal.SIG_IGN else []
    return [signal.SIGINT, signal.SIGTERM, *hang_up]


class FarmError(Exception):
    """code: the exit code, as glim's: 1 bad input, 2 usage, 3 device. file: the one that is to blame, if that is known."""

    def __init__(self, sentence, code=1, file=None):
        super().__init__(sentence)
        self.code, self.file = code, file
