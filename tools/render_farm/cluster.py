"""Dask's workers: processes of this machine, or those of a scheduler. To be imported within the environment that has Dask."""

import asyncio
import contextlib
import logging
import os
import tempfile

os.environ.setdefault("DASK_LOGGING__DISTRIBUTED", "critical")  # the farm says itself what happens to workers; read at the import
QUIET = logging.CRITICAL  # clusters set the level once more

import dask  # noqa: E402
import distributed  # noqa: E402

from render_farm.errors import FarmError  # noqa: E402

CONNECT_SECONDS = 10
NO_HTTP = os.path.join(os.path.dirname(os.path.realpath(__file__)), "no_http.py")


@contextlib.asynccontextmanager
async def connect(options, wanted):
    """Yields a client. wanted: the number of workers that have something to do. Refuses (FarmError) a scheduler that does not answer."""
    with tempfile.TemporaryDirectory(prefix="glim-farm-") as scratch, dask.config.set({
        # Dask would take a folder in /tmp whose name anyone can guess and make first, and would import modules from it.
        "temporary-directory": scratch, "distributed.worker.preload": [NO_HTTP],
        # The farm counts failures itself; Dask would blame a part for workers that died of other causes.
        "distributed.scheduler.allowed-failures": 1000, "distributed.scheduler.work-stealing": False,
        # A part takes seconds to minutes; Dask's measurements of itself, up to a hundred a second, cost 3 % of a core a process.
        "distributed.worker.profile.enabled": False, "distributed.admin.tick.interval": "1s",
        "distributed.admin.system-monitor.interval": "5s"}):
        async with (connect_to_scheduler if options.scheduler else start_cluster)(options, wanted) as client:
            yield client


def make_security(options):
    """The user's certificates, or (FarmError, OSError) a refusal. Without them one for this farm alone, which stays in the
    memory of its processes."""
    if not options.tls_ca:
        return distributed.Security.temporary()
    security = distributed.Security(
        require_encryption=True, tls_ca_file=options.tls_ca,
        **{"tls_%s_%s" % (role, what): value for role in ("client", "scheduler", "worker")
           for what, value in (("cert", options.tls_cert), ("key", options.tls_key))})
    for path in (options.tls_ca, options.tls_cert, options.tls_key):
        with open(path, "rb"):
            pass
    try:
        security.get_connection_args("client")
    except OSError as error:
        raise FarmError("--tls-ca %s, --tls-cert %s, --tls-key %s: do not go together, or are no PEM files (%s)"
                        % (options.tls_ca, options.tls_cert, options.tls_key, error)) from error
    return security


@contextlib.asynccontextmanager
async def start_cluster(options, wanted):
    security, dashboard = make_security(options), "127.0.0.1:0" if options.dashboard else None
    if not dashboard:
        from render_farm import no_http  # noqa: F401
    if options.slurm:
        from render_farm.slurm import adapt, make_slurm_cluster
        cluster = make_slurm_cluster(options, security, dashboard, NO_HTTP, QUIET)
    else:
        cluster = distributed.LocalCluster(n_workers=options.local, threads_per_worker=1, processes=True, host="127.0.0.1",
                                           protocol="tls://", security=security, dashboard_address=dashboard, memory_limit=0,
                                           silence_logs=QUIET, asynchronous=True)
    start = asyncio.ensure_future(cluster)
    try:
        try:
            await asyncio.shield(start)  # Dask cannot close what has half begun
        except RuntimeError as error:  # a worker that is killed while it starts
            raise FarmError("a worker of this machine did not start: %s" % error) from error
        if options.slurm:
            adapt(cluster, options.workers, wanted)
        async with distributed.Client(cluster, asynchronous=True) as client:
            yield client
    finally:
        with contextlib.suppress(Exception):  # it is raised above
            await start
        await cluster.close()


@contextlib.asynccontextmanager
async def connect_to_scheduler(options, _wanted):
    security = make_security(options) if options.tls_ca else None
    try:
        client = await distributed.Client(options.scheduler, security=security, timeout=CONNECT_SECONDS, asynchronous=True)
    except OSError as error:
        raise FarmError("--scheduler %s: no scheduler answers there (%s)" % (options.scheduler, error)) from error
    async with client:
        yield client
