"""Dask's workers: processes of this machine, or those of a scheduler. To be imported within the environment that has Dask."""

import contextlib
import os

os.environ.setdefault("DASK_LOGGING__DISTRIBUTED", "critical")  # the farm says itself what happens to workers; read at the import

import dask  # noqa: E402
import distributed  # noqa: E402

from render_farm.errors import FarmError  # noqa: E402

CONNECT_SECONDS = 10


@contextlib.asynccontextmanager
async def connect(options, wanted):
    """Yields a client. wanted: the number of workers that have something to do. Refuses (FarmError) a scheduler that does not answer."""
    dask.config.set({
        # The farm counts failures itself; Dask would blame a part for workers that died of other causes.
        "distributed.scheduler.allowed-failures": 1000, "distributed.scheduler.work-stealing": False,
        # A part takes seconds to minutes; Dask's measurements of itself, up to a hundred a second, cost 3 % of a core a process.
        "distributed.worker.profile.enabled": False, "distributed.admin.tick.interval": "1s", "distributed.admin.system-monitor.interval": "5s"})
    security = distributed.Security(
        require_encryption=True, tls_ca_file=options.tls_ca,
        **{"tls_%s_%s" % (role, what): value for role in ("client", "scheduler", "worker")
           for what, value in (("cert", options.tls_cert), ("key", options.tls_key))}) if options.tls_ca else None
    if options.slurm:
        from render_farm.slurm import adapt, make_slurm_cluster
        async with make_slurm_cluster(options, security) as cluster:
            adapt(cluster, options.workers, wanted)
            async with distributed.Client(cluster, asynchronous=True) as client:
                yield client
        return
    if options.scheduler is None:
        try:
            cluster = await distributed.LocalCluster(n_workers=options.local, threads_per_worker=1, processes=True, host="127.0.0.1",
                                                     dashboard_address="127.0.0.1:0", memory_limit=0, asynchronous=True)
        except RuntimeError as error:  # a worker that is killed while it starts
            raise FarmError("a worker of this machine did not start: %s" % error) from error
        async with cluster:
            async with distributed.Client(cluster, asynchronous=True) as client:
                yield client
        return
    try:
        client = await distributed.Client(options.scheduler, security=security, timeout=CONNECT_SECONDS, asynchronous=True)
    except OSError as error:
        raise FarmError("--scheduler %s: no scheduler answers there (%s)" % (options.scheduler, error)) from error
    async with client:
        yield client
