"""Workers that Slurm starts, one a job. To be imported within the environment that has Dask and dask-jobqueue."""

import shlex

from dask_jobqueue import SLURMCluster
from distributed.deploy.adaptive import Adaptive

REPLACED = ["#SBATCH --mem=", "#SBATCH --cpus-per-task=", "#SBATCH -t "]  # dask-jobqueue's own; --slurm has the user's
SCRATCH = ["scratch=$(mktemp -d) || exit", "trap 'rm -rf \"$scratch\"' EXIT", "export TMPDIR=$scratch"]  # of the worker alone


def make_slurm_cluster(options, security, dashboard, preload, log_level):
    # Of an hour 55 minutes, give or take 4: workers end in time, and not all at once.
    lifetime, stagger = options.slurm.seconds * 11 // 12, options.slurm.seconds // 15
    return SLURMCluster(
        cores=1, processes=1, memory="1GB", job_directives_skip=REPLACED, job_extra_directives=options.slurm.directives,
        job_script_prologue=SCRATCH,
        worker_extra_args=["--memory-limit", "0", "--lifetime", "%ds" % lifetime, "--lifetime-stagger", "%ds" % stagger,
                           "--no-dashboard", "--preload", shlex.quote(preload)],
        protocol="tls://", security=security, shared_temp_directory=options.output + ".farm",  # certificates, in files that are ours alone
        scheduler_options={"dashboard_address": dashboard}, log_directory=options.output + ".farm",
        silence_logs=log_level, asynchronous=True)


def adapt(cluster, bounds, wanted):
    """Asks Slurm for as many workers as are wanted, within bounds, and for others in place of those whose time is over."""
    class Wanted(Adaptive):
        async def target(self):
            return wanted()
    cluster.adapt(Adaptive=Wanted, minimum=bounds[0], maximum=bounds[1])
