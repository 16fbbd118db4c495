"""The course's write-up, remade: measures with glim, writes one HTML page and study.json. Started by tools/study."""
