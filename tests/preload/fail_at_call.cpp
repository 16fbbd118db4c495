// Preloaded into glim: the n-th system call that changes files in a folder ends the process as kill -9 does, or every one from there on
// fails as on a full disk.
//
// GLIM_FAIL_FOLDER  the folder
// GLIM_FAIL_AT      n, from 1 on
// GLIM_FAIL_HOW     kill or full
#include <dlfcn.h>
#include <fcntl.h>
#include <unistd.h>

#include <atomic>
#include <cerrno>
#include <csignal>
#include <cstdarg>
#include <cstdlib>
#include <cstring>
#include <string>

namespace {

template <class Function>
Function* original(const char* name)
{
    return reinterpret_cast<Function*>(dlsym(RTLD_NEXT, name));
}

bool isInFolder(const char* path)
{
    const char* folder = std::getenv("GLIM_FAIL_FOLDER");
    return folder != nullptr && std::strncmp(path, folder, std::strlen(folder)) == 0;
}

bool isInFolder(int file)
{
    char path[4096] = {};
    return readlink(("/proc/self/fd/" + std::to_string(file)).c_str(), path, sizeof path - 1) > 0 && isInFolder(path);
}

// Whether the call is to fail.
bool countCall()
{
    static std::atomic<int> calls = 0;
    const char *at = std::getenv("GLIM_FAIL_AT"), *how = std::getenv("GLIM_FAIL_HOW");
    if (at == nullptr || how == nullptr || ++calls < std::atoi(at)) {
        return false;
    }
    if (std::strcmp(how, "kill") == 0) {
        kill(getpid(), SIGKILL);
    }
    errno = ENOSPC;
    return true;
}

}  // namespace

extern "C" {

int open(const char* path, int flags, ...)
{
    va_list list;
    va_start(list, flags);
    const mode_t mode = va_arg(list, mode_t);
    va_end(list);
    if ((flags & (O_CREAT | O_TMPFILE)) != 0 && (flags & O_ACCMODE) != O_RDONLY && isInFolder(path) && countCall()) {
        return -1;
    }
    return original<int(const char*, int, ...)>("open")(path, flags, mode);
}

ssize_t write(int file, const void* bytes, size_t count)
{
    return isInFolder(file) && countCall() ? -1 : original<ssize_t(int, const void*, size_t)>("write")(file, bytes, count);
}

int fsync(int file) { return isInFolder(file) && countCall() ? -1 : original<int(int)>("fsync")(file); }

int linkat(int fromFolder, const char* from, int toFolder, const char* to, int flags)
{
    return isInFolder(to) && countCall()
               ? -1
               : original<int(int, const char*, int, const char*, int)>("linkat")(fromFolder, from, toFolder, to, flags);
}

int rename(const char* from, const char* to)
{
    return isInFolder(to) && countCall() ? -1 : original<int(const char*, const char*)>("rename")(from, to);
}
}
