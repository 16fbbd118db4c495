"""Workers that Slurm starts, one a job. To be imported within the environment that has Dask and dask-jobqueue."""

from dask_jobqueue import SLURMCluster
from distributed.deploy.adaptive import Adaptive

REPLACED = ["#SBATCH --mem=", "#SBATCH --cpus-per-task=", "#SBATCH -t "]  # dask-jobqueue's own; --slurm has the user's


def make_slurm_cluster(options, security):
    # Of an hour 55 minutes, give or take 4: workers end in time, and not all at once.
    lifetime, stagger = options.slurm.seconds * 11 // 12, options.slurm.seconds // 15
    return SLURMCluster(
        cores=1, processes=1, memory="1GB", job_directives_skip=REPLACED, job_extra_directives=options.slurm.directives,
        worker_extra_args=["--memory-limit", "0", "--lifetime", "%ds" % lifetime, "--lifetime-stagger", "%ds" % stagger],
        protocol="tls://" if security else "tcp://", security=security, scheduler_options={"dashboard_address": "127.0.0.1:0"},
        log_directory=options.output + ".farm", asynchronous=True)


def adapt(cluster, bounds, wanted):
    """Asks Slurm for as many workers as are wanted, within bounds, and for others in place of those whose time is over."""
    class Wanted(Adaptive):
        async def target(self):
            return wanted()
    cluster.adapt(Adaptive=Wanted, minimum=bounds[0], maximum=bounds[1])
