"""What the farm needs from PyPI; workers on other machines need the same."""

from conversion.environment import Environment

ENVIRONMENT = Environment("farm", ["dask==2026.8.0", "distributed==2026.8.0", "cryptography==50.0.2"])  # which makes certificates
DASHBOARD = "bokeh==3.9.2"  # for --dashboard alone
JOBQUEUE = "dask-jobqueue==0.9.0"  # for --slurm alone
