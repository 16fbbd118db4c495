"""What the farm needs from PyPI; workers on other machines need the same."""

from conversion.environment import Environment

ENVIRONMENT = Environment("farm", ["dask==2026.8.0", "distributed==2026.8.0", "bokeh==3.9.2"])  # bokeh draws Dask's dashboard
JOBQUEUE = "dask-jobqueue==0.9.0"  # for --slurm alone
