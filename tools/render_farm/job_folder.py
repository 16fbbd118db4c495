"""The folder of a job, which is all that lasts: what is asked, and what is rendered already."""

import contextlib
import fcntl
import json
import os
import shutil

from render_farm.errors import FarmError
from whole_file import sync_folder, write_whole


def check_place(path):
    """Refuses (FarmError) the name of a file that could not be written once everything is rendered."""
    if not os.path.isdir(os.path.dirname(path)):
        raise FarmError("%s: cannot be made: the folder %s does not exist" % (path, os.path.dirname(path)))
    if os.path.isdir(path):
        raise FarmError("%s: cannot be made: it is a folder" % path)


class JobFolder:
    """OUT.exr.farm, made and locked by `hold`. `pages` within it holds films that wait to be folded."""

    def __init__(self, output):
        self.path = output + ".farm"
        self.pages = os.path.join(self.path, "pages")
        self.film = os.path.join(self.path, "film.exr")

    def hold(self, job, about):
        """Keeps the job. job: what decides its bits. about: what else a reader wants to know. Refuses (FarmError) another job,
        and another process on the same."""
        self.take_lock()
        path = os.path.join(self.path, "job.json")
        if os.path.exists(path):
            held = self.read_job(path)
            for name in job:
                if held.get(name) != job[name]:
                    raise FarmError("%s holds another job: its %s is %s, expected %s; finish that one, or remove the folder"
                                    % (self.path, name, json.dumps(held.get(name)), json.dumps(job[name])))
        write_whole(path, json.dumps({"job": job, **about}, indent=1).encode())

    def read_job(self, path):
        with contextlib.suppress(ValueError, RecursionError):  # what json.load raises
            with open(path, encoding="utf-8") as file:
                held = json.load(file)
            if isinstance(held, dict) and isinstance(held.get("job"), dict):
                return held["job"]
        raise FarmError("%s: is damaged; remove %s to begin anew" % (path, self.path))

    def take_lock(self):
        with contextlib.suppress(FileExistsError):
            os.mkdir(self.path, 0o700)
        if os.lstat(self.path).st_uid != os.geteuid():
            raise FarmError("%s: belongs to another user, who could change what is rendered" % self.path)
        if os.path.islink(self.path) or not self.is_ours():
            raise FarmError("%s: is no folder of a farm; expected none of this name" % self.path)
        self.lock = os.open(self.path, os.O_RDONLY | os.O_DIRECTORY | os.O_NOFOLLOW)  # until this process ends
        os.fchmod(self.lock, 0o700)  # certificates of Slurm's jobs are in it
        os.makedirs(self.pages, exist_ok=True)
        try:
            fcntl.flock(self.lock, fcntl.LOCK_EX | fcntl.LOCK_NB)
        except BlockingIOError as error:
            raise FarmError("%s: another farm works on it now" % self.path) from error

    def is_ours(self):
        """Nothing but a farm's folder may be removed at the end. One that was killed at the beginning has `pages` at most."""
        return os.path.isdir(self.path) and (os.path.exists(os.path.join(self.path, "job.json"))
                                             or all(name == "pages" or name.startswith(".glim-") for name in os.listdir(self.path)))

    def remove(self):
        shutil.rmtree(self.path)
        sync_folder(os.path.dirname(self.path))
