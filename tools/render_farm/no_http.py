"""Dask without its web servers: they authenticate nobody, and tell whoever asks what runs where. To be imported before a scheduler or a
worker starts, as --preload of `dask scheduler` and `dask worker` does. Both need --no-dashboard too, which has no server of its own."""

from distributed.node import ServerNode

ServerNode.start_http_server = lambda *_, **__: None
