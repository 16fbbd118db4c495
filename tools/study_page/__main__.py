"""tools/study: parses, runs, and turns each failure into one sentence and an exit code."""

import signal
import sys

from .arguments import parse_arguments
from .errors import StudyError


def stop(number, _frame):
    raise SystemExit(128 + number)


def main():
    options = parse_arguments()
    for number in (signal.SIGTERM, signal.SIGHUP):
        if signal.getsignal(number) != signal.SIG_IGN:  # as nohup has it
            signal.signal(number, stop)
    try:
        if options.serve:
            from .live.server import serve_study
            serve_study(options)
        else:
            # Only now: plots take a while to load, and usage should not need them.
            from .study import run_study
            print(run_study(options, sys.argv[1:]), end="")
    except (StudyError, OSError) as error:
        sys.exit("tools/study: %s" % error)
    except KeyboardInterrupt:
        sys.exit(128 + signal.SIGINT)


if __name__ == "__main__":
    main()
