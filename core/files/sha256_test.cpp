#include "core/files/sha256.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>

#include "core/files/access.h"
#include "core/files/temporary_folder_harness.h"

namespace trapeze {
namespace {

/// Examples of NIST for FIPS 180-4; the third has two blocks, the last 15625 and a length of three bytes.
TEST(Sha256, GivesTheStandardsExamples) {
    EXPECT_EQ(sha256(""), "e3b0c44298fc1c149afbf4c8996fb92427ae41e4649b934ca495991b7852b855");
    EXPECT_EQ(sha256("abc"), "ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad");
    EXPECT_EQ(sha256("abcdbcdecdefdefgefghfghighijhijkijkljklmklmnlmnomnopnopq"),
              "248d6a61d20638b8e5c026930c3e6039a33ce45964ff2167f6ecedd419db06c1");
    EXPECT_EQ(sha256(std::string(1'000'000, 'a')),
              "cdc76e5c9914fb9281a1c7e284d73e67f1809a48a497200e046d39ccc7112cd0");
}

/// Where padding needs a block of its own, and where it does not: by `printf 'a%.0s' {1..N} | sha256sum`.
TEST(Sha256, PadsAtTheEndsOfBlocks) {
    EXPECT_EQ(sha256(std::string(55, 'a')),
              "9f4390f8d30c2dd92ec9f095b65e2b9ae9b0a925a5258e241c9f1e910f734318");
    EXPECT_EQ(sha256(std::string(56, 'a')),
              "b35439a4ac6f0948b6d6f9e3c6af0f5f590ce20f1bde7090ef7970686ec6738a");
    EXPECT_EQ(sha256(std::string(64, 'a')),
              "ffe054fe7ae0cb6dc65c3af9b61d5209f439851db43d0ba5997337df154668eb");
}

TEST(Sha256, HashesFilesAndTellsWhereThereIsNone) {
    const testing::TemporaryFolder folder;
    const std::string path = folder.file("file"), text(200'001, 'x');
    std::ofstream(path, std::ios::binary) << text;
    EXPECT_EQ(hash_of_file(path), (FileHash{200'001, sha256(text)}));
    EXPECT_FALSE(hash_of_file(path + "-not"));
    EXPECT_FALSE(hash_of_file(folder.path()));
}

TEST(ReadNames, AreThoseOfFilesThatWereOpened) {
    const testing::TemporaryFolder folder;
    const std::string path = folder.file("file"), other = path + "-not";
    std::ofstream(path) << "x";
    const auto reads = std::make_shared<ReadNames>();
    Access access;
    access.record_reads(reads);
    const Access copy = access;
    std::string bytes;
    EXPECT_TRUE(copy.read(path, 10, &bytes));
    EXPECT_FALSE(access.read(other, 10, &bytes));
    EXPECT_EQ(access.open_to_read(other), nullptr);
    EXPECT_EQ(reads->names(), std::set<std::string>{path});
}

}  // namespace
}  // namespace trapeze
