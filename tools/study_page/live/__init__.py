"""The study's experiments on a page that renders them when asked: tools/study --serve."""
