"""Remakes the course's write-up: measures with glim, and writes one HTML page and study.json. Started by tools/study."""
