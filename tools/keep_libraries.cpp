// Linked into sanitized programs only: a library that stays loaded can be named in a leak report. Without this the
// leaks of the Vulkan validation layer come from `<unknown module>`, which no suppression can match.
extern "C" int dlclose(void* library);
extern "C" int dlclose(void* /*library*/) { return 0; }
