#include "pipeline/rib/syntax/zip_archive.h"

#include <zlib.h>

#include "pipeline/rib/reading_harness.h"

namespace trapeze::testing {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

std::string bytes(uint64_t value, int count) {
    std::string text;
    for (int i = 0; i < count; ++i) text += static_cast<char>(i < 8 ? value >> (8 * i) : 0);
    return text;
}

std::string deflated(const std::string& text) {
    z_stream stream{};
    deflateInit2(&stream, 9, Z_DEFLATED, -15, 8, Z_DEFAULT_STRATEGY);
    std::string packed(text.size() + 100, '\0');
    stream.next_in = reinterpret_cast<Bytef*>(const_cast<char*>(text.data()));
    stream.avail_in = static_cast<uInt>(text.size());
    stream.next_out = reinterpret_cast<Bytef*>(packed.data());
    stream.avail_out = static_cast<uInt>(packed.size());
    deflate(&stream, Z_FINISH);
    packed.resize(stream.total_out);
    deflateEnd(&stream);
    return packed;
}

struct Member {
    std::string name, text;
    bool packed = false;
};

/// As PKWARE's APPNOTE.TXT lays it out; nothing that the reader does not look at is filled in.
std::string zip(const std::vector<Member>& members) {
    std::string files, directory;
    for (const Member& member : members) {
        const std::string data = member.packed ? deflated(member.text) : member.text;
        const std::string sizes = bytes(static_cast<uint32_t>(data.size()), 4) +
                                  bytes(static_cast<uint32_t>(member.text.size()), 4);
        const std::string method = bytes(member.packed ? 8 : 0, 2);
        const std::string name_length = bytes(static_cast<uint32_t>(member.name.size()), 2);
        directory += bytes(0x02014b50, 4) + bytes(0, 4) + bytes(0, 2) + method + bytes(0, 8) + sizes +
                     name_length + bytes(3, 2) + bytes(0, 10) +
                     bytes(static_cast<uint32_t>(files.size()), 4) + member.name + "xyz";
        files += bytes(0x04034b50, 4) + bytes(0, 2) + bytes(0, 2) + method + bytes(0, 8) + sizes +
                 name_length + bytes(2, 2) + member.name + "ab" + data;
    }
    return files + directory + bytes(0x06054b50, 4) + bytes(0, 8) +
           bytes(static_cast<uint32_t>(directory.size()), 4) + bytes(static_cast<uint32_t>(files.size()), 4) +
           bytes(7, 2) + "comment";
}

const std::vector<Member> kMembers = {
    {"a.rib", kSphere},
    {"sub/b.rib", "ReadArchive \"c.rib\" " + std::string(1000, ' ') + kSphere, true},
    {"sub/c.rib", kSphere, true}};

TEST(ZipArchives, NamesAreSplitAtTheMark) {
    EXPECT_EQ(rib::zip_member_named("x/job.zip!sub/b.rib")->archive, "x/job.zip");
    EXPECT_EQ(rib::zip_member_named("x/job.zip!sub/b.rib")->member, "sub/b.rib");
    for (const char* name : {"a.rib", "!a", "a!", ""}) EXPECT_FALSE(rib::zip_member_named(name)) << name;
}

TEST(ZipArchives, MembersAreReadStoredAndPacked) {
    const Folder folder;
    folder.write("job.zip", zip(kMembers));
    const ReadOutcome outcome =
        read_files(folder, {folder.write("a.rib",
                                         "WorldBegin ReadArchive \"job.zip!a.rib\" Procedural2 "
                                         "\"DelayedReadArchive2\" \"SimpleBound\" \"string filename\" "
                                         "[\"job.zip!sub/b.rib\"] WorldEnd")});
    EXPECT_THAT(outcome.messages, IsEmpty());
    EXPECT_EQ(outcome.count(), 3u);
}

TEST(ZipArchives, WhatIsNotThereIsSaid) {
    const Folder folder;
    folder.write("job.zip", zip(kMembers));
    folder.write("empty.zip", "");
    const ReadOutcome outcome =
        read_files(folder, {folder.write("a.rib",
                                         "WorldBegin ReadArchive \"job.zip!no.rib\" ReadArchive "
                                         "\"none.zip!a.rib\" ReadArchive \"empty.zip!a\" " +
                                             kSphere + "WorldEnd")});
    EXPECT_EQ(outcome.messages.size(), 3u);
    EXPECT_THAT(outcome.messages[0], HasSubstr("\"job.zip!no.rib\" is not found"));
    EXPECT_EQ(outcome.count(), 1u);
}

TEST(ZipArchives, LimitsHold) {
    const Folder folder;
    const std::string path = folder.write(
        "bomb.zip", zip({{"a", std::string(5000000, ' '), true}, {"b", std::string(2000, ' ')}}));
    std::string error;
    EXPECT_FALSE(rib::read_zip_member({path, "a"}, 1000000, &error));
    EXPECT_THAT(error, HasSubstr("inflates to more than"));
    EXPECT_TRUE(rib::read_zip_member({path, "b"}, 2000, &error));
    EXPECT_FALSE(rib::read_zip_member({path, "b"}, 1999, &error));
}

TEST(ZipArchives, EveryPrefixAndEveryChangedByteEndsWithoutHarm) {
    const Folder folder;
    const std::string whole = zip(kMembers);
    std::string error;
    for (size_t length = 0; length < whole.size(); length += 3)
        rib::read_zip_member({folder.write("cut.zip", whole.substr(0, length)), "sub/c.rib"}, 100000, &error);
    int read = 0;
    for (size_t at = 0; at < whole.size(); ++at) {
        std::string changed = whole;
        changed[at] = static_cast<char>(changed[at] ^ 0xff);
        read +=
            rib::read_zip_member({folder.write("changed.zip", changed), "sub/c.rib"}, 100000, &error) ? 1 : 0;
    }
    EXPECT_GT(read, 100);  // most bytes belong to other members
    EXPECT_LT(read, static_cast<int>(whole.size()));
}

}  // namespace
}  // namespace trapeze::testing
