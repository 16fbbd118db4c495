"""Dask without its web servers, unless a dashboard is asked for: they authenticate nobody, and tell whoever asks what runs where. To be
imported before a scheduler or a worker starts: --preload of `dask scheduler` and `dask worker` does that."""

from distributed.node import ServerNode

start_http_server = ServerNode.start_http_server


def start_if_asked(node, routes, dashboard_address, *more, **others):
    if dashboard_address:
        start_http_server(node, routes, dashboard_address, *more, **others)


ServerNode.start_http_server = start_if_asked
