#include "host/atomic_file.hpp"
#include "host/error.hpp"
#include "tests/support/expect_message.hpp"
#include "tests/support/scratch_folder.hpp"

#include <gtest/gtest.h>

#include <fcntl.h>
#include <sys/file.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <unistd.h>

#include <csignal>
#include <cstring>

namespace glim {
namespace {

using test::expectRefusal;
using test::Parts;
using test::readFileBytes;
using test::ScratchFolder;
using test::writeText;

void expectUnwritable(const std::filesystem::path& path, MessageId id, Parts parts)
{
    parts.file = path;
    expectRefusal<InputError>([&] { checkWritable(path); }, id, parts);
}

TEST(AtomicFile, AppearsOnlyWhenCommitted)
{
    const ScratchFolder folder;
    const auto path = folder / "a.exr";
    {
        AtomicFile file(path);
        file.write("half", 4);
        EXPECT_FALSE(std::filesystem::exists(path));
    }
    EXPECT_EQ(folder.entries(), 0);
    AtomicFile file(path);
    file.write("0123456789", 10);
    file.seek(2);
    file.write("ab", 2);
    EXPECT_EQ(file.tell(), 4U);
    file.commit();
    EXPECT_EQ(readFileBytes(path), "01ab456789");
    EXPECT_EQ(folder.entries(), 1);
}

TEST(AtomicFile, KeepsTheOldFileAndNothingElseWhenTheDiskIsFull)
{
    const ScratchFolder folder;
    const auto path = folder / "a.exr";
    writeText(path, "old");
    rlimit before{};
    getrlimit(RLIMIT_FSIZE, &before);
    const rlimit tiny{100, before.rlim_max};
    const auto handler = std::signal(SIGXFSZ, SIG_IGN);
    setrlimit(RLIMIT_FSIZE, &tiny);
    expectRefusal<InputError>(
        [&] {
            AtomicFile file(path);
            file.write(std::string(1000, 'x').data(), 1000);
            file.commit();
        },
        MessageId::FileUnwritable, {.file = "a.exr", .value = "File too large"});
    setrlimit(RLIMIT_FSIZE, &before);
    std::signal(SIGXFSZ, handler);
    EXPECT_EQ(readFileBytes(path), "old");
    EXPECT_EQ(folder.entries(), 1);
}

TEST(AtomicFile, APrivateOneIsForItsUserAloneAndFollowsNoLink)
{
    const ScratchFolder folder;
    const auto path = folder / "cache";
    writeText(path, "old");
    ASSERT_EQ(chmod(path.c_str(), 0666), 0);
    AtomicFile file(path, FileAccess::Private);
    file.write("new", 3);
    file.commit();
    EXPECT_EQ(readFileBytes(path), "new");
    struct stat status = {};
    ASSERT_EQ(stat(path.c_str(), &status), 0);
    EXPECT_EQ(status.st_mode & 07777U, 0600U);
    std::filesystem::create_symlink(path, folder / "link");
    expectRefusal<InputError>([&] { AtomicFile link(folder / "link", FileAccess::Private); }, MessageId::Cycle, {.file = "link"});
}

TEST(AtomicFile, TwoAtOnceDoNotMeet)
{
    const ScratchFolder folder;
    AtomicFile a(folder / "a"), b(folder / "b");
    a.write("a", 1);
    b.write("b", 1);
    b.commit();
    a.commit();
    EXPECT_EQ(readFileBytes(folder / "a") + readFileBytes(folder / "b"), "ab");
}

TEST(AtomicFile, WritesThroughASymbolicLink)
{
    const ScratchFolder folder;
    std::filesystem::create_directory(folder / "real");
    writeText(folder / "real/a.exr", "old");
    std::filesystem::create_symlink("real/a.exr", folder / "a.exr");
    AtomicFile file(folder / "a.exr");
    file.write("new", 3);
    file.commit();
    EXPECT_TRUE(std::filesystem::is_symlink(folder / "a.exr"));
    EXPECT_EQ(readFileBytes(folder / "real/a.exr"), "new");
}

TEST(AtomicFile, MakesTheFileThatALinkLeadsTo)
{
    const ScratchFolder folder;
    std::filesystem::create_directory(folder / "real");
    std::filesystem::create_symlink("real/b.exr", folder / "a.exr");
    std::filesystem::create_symlink("a.exr", folder / "again.exr");
    AtomicFile file(folder / "again.exr");
    file.commit();
    EXPECT_TRUE(std::filesystem::is_symlink(folder / "again.exr"));
    EXPECT_TRUE(std::filesystem::is_symlink(folder / "a.exr"));
    EXPECT_TRUE(std::filesystem::is_regular_file(folder / "real/b.exr"));
}

TEST(AtomicFile, HasTheModeOfAnOrdinaryNewFile)
{
    const ScratchFolder folder;
    const mode_t before = umask(027);
    AtomicFile file(folder / "a");
    file.commit();
    umask(before);
    struct stat status {};
    stat((folder / "a").c_str(), &status);
    EXPECT_EQ(status.st_mode & 0777U, 0640U);
}

TEST(AtomicFile, KeepsTheModeOfTheFileThatItReplaces)
{
    const ScratchFolder folder;
    for (const mode_t mode : {0600U, 0664U, 0755U}) {
        writeText(folder / "a", "old");
        ASSERT_EQ(chmod((folder / "a").c_str(), mode), 0);
        std::filesystem::create_symlink("a", folder / "link");
        AtomicFile file(folder / "link");
        file.write("new", 3);
        file.commit();
        struct stat status {};
        stat((folder / "a").c_str(), &status);
        EXPECT_EQ(status.st_mode & 07777U, mode);
        EXPECT_EQ(readFileBytes(folder / "a"), "new");
        std::filesystem::remove(folder / "link");
    }
}

TEST(AtomicFile, NobodyCanTakeAllNames)
{
    const ScratchFolder folder;
    std::filesystem::create_directory(hiddenBeside(folder / "a", ".partial"));
    for (int i = 0; i < 100; ++i) {
        std::filesystem::create_directory(hiddenBeside(folder / "a", "." + std::to_string(i) + ".partial"));
    }
    AtomicFile file(folder / "a");
    file.write("new", 3);
    file.commit();
    EXPECT_EQ(readFileBytes(folder / "a"), "new");
    EXPECT_EQ(folder.entries(), 102);
}

// Those of other programs and users, which a folder for all may have.
TEST(AtomicFile, SkipsTemporaryNamesThatExist)
{
    const ScratchFolder folder;
    const auto temporary = hiddenBeside(folder / "a", ".partial");
    const auto expectWritten = [&](const char* what) {
        AtomicFile file(folder / "a");
        file.write(what, std::strlen(what));
        file.commit();
        EXPECT_EQ(readFileBytes(folder / "a"), what);
    };
    writeText(folder / "foreign", "foreign");
    std::filesystem::create_symlink("foreign", temporary);
    expectWritten("link");
    EXPECT_EQ(readFileBytes(folder / "foreign"), "foreign");
    EXPECT_TRUE(std::filesystem::is_symlink(temporary));
    std::filesystem::remove(temporary);
    ASSERT_EQ(mkfifo(temporary.c_str(), 0600), 0);
    expectWritten("pipe");
    std::filesystem::remove(temporary);
    std::filesystem::create_directory(temporary);
    expectWritten("folder");
    std::filesystem::remove(temporary);
    writeText(temporary, "of another process");
    const int held = open(temporary.c_str(), O_RDWR);
    ASSERT_EQ(flock(held, LOCK_EX), 0);
    expectWritten("held");
    close(held);
    EXPECT_TRUE(std::filesystem::exists(temporary));
    expectWritten("left");
    EXPECT_FALSE(std::filesystem::exists(temporary)) << "a leftover";
    EXPECT_EQ(folder.entries(), 2);
}

TEST(CheckWritable, AcceptsNewAndExistingFilesAndTouchesNothing)
{
    const ScratchFolder folder;
    checkWritable(folder / "new.exr");
    checkWritable("relative.exr");
    checkWritable(folder / "any.name");
    EXPECT_EQ(folder.entries(), 0);
    writeText(folder / "old.exr", "old");
    checkWritable(folder / "old.exr");
    EXPECT_EQ(readFileBytes(folder / "old.exr"), "old");
}

TEST(CheckWritable, RefusesWithTheReason)
{
    const ScratchFolder folder;
    std::filesystem::create_directory(folder / "folder.exr");
    writeText(folder / "file", "");
    expectUnwritable(folder / "missing/a.exr", MessageId::FileMissing, {.value = folder / "missing"});
    expectUnwritable(folder / "folder.exr", MessageId::WrongType, {.value = "a folder"});
    expectUnwritable(folder / "file/a.exr", MessageId::WrongType, {.value = folder / "file", .expected = "a folder"});
    std::filesystem::create_symlink("circle.exr", folder / "circle.exr");
    expectUnwritable(folder / "circle.exr", MessageId::Cycle, {});
    std::filesystem::create_symlink("missing/b.exr", folder / "nowhere.exr");
    expectUnwritable(folder / "nowhere.exr", MessageId::FileMissing, {.value = folder / "missing"});
    expectRefusal<InputError>([] { checkWritable(""); }, MessageId::Missing);
    const Parts device{.file = "/dev/null", .expected = "a regular file"};
    expectRefusal<InputError>([] { checkWritable("/dev/null"); }, MessageId::WrongType, device);
    expectRefusal<InputError>([] { AtomicFile file("/dev/null"); }, MessageId::WrongType, device);
}

TEST(CheckWritable, RefusesWithoutPermission)
{
    const ScratchFolder folder;
    std::filesystem::create_directory(folder / "closed");
    writeText(folder / "kept.exr", "");
    const uid_t user = geteuid();
    constexpr uid_t kNobody = 65534;
    if (user == 0) {  // root may write anything: act as somebody else
        ASSERT_EQ(chown(folder.path().c_str(), kNobody, static_cast<gid_t>(-1)), 0);
        ASSERT_EQ(chown((folder / "kept.exr").c_str(), kNobody, static_cast<gid_t>(-1)), 0);
        ASSERT_EQ(seteuid(kNobody), 0);
    } else {
        ASSERT_EQ(chmod((folder / "closed").c_str(), 0500), 0);
    }
    ASSERT_EQ(chmod((folder / "kept.exr").c_str(), 0444), 0);
    expectUnwritable(folder / "closed/a.exr", MessageId::FileUnwritable, {.place = folder / "closed", .value = "Permission denied"});
    expectUnwritable(folder / "kept.exr", MessageId::FileUnwritable, {.value = "Permission denied"});
    ASSERT_EQ(seteuid(user), 0);
}

}  // namespace
}  // namespace glim
