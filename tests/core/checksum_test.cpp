// SPDX-License-Identifier: BSD-3-Clause
// SHA-256: published digests, files larger than a block, files that cannot be read.
#include "roomgraph/core/checksum.h"

#include <gmock/gmock.h>

#include "errors_of.h"
#include "roomgraph/core/errors.h"
#include "temporary_folder.h"

namespace roomgraph::test {
namespace {

// FIPS 180-2, appendix B.
TEST(Sha256, PublishedDigests) {
  EXPECT_EQ(sha256Of(""), "e3b0c44298fc1c149afbf4c8996fb92427ae41e4649b934ca495991b7852b855");
  EXPECT_EQ(sha256Of("abc"), "ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad");
  EXPECT_EQ(sha256Of("abcdbcdecdefdefgefghfghighijhijkijkljklmklmnlmnomnopnopq"),
            "248d6a61d20638b8e5c026930c3e6039a33ce45964ff2167f6ecedd419db06c1");
}

TEST(Sha256, OfAFileOfManyBlocks) {
  TemporaryFolder folder;
  EXPECT_EQ(sha256OfFile(folder.write("million", std::string(1000000, 'a'))),
            "cdc76e5c9914fb9281a1c7e284d73e67f1809a48a497200e046d39ccc7112cd0");
  EXPECT_EQ(sha256OfFile(folder.write("empty", "")), sha256Of(""));
}

TEST(Sha256, FilesThatCannotBeRead) {
  TemporaryFolder folder;
  EXPECT_THAT(messageOf<InputError>([&] { sha256OfFile(folder.file("none")); }),
              ::testing::AllOf(::testing::HasSubstr("none"), ::testing::HasSubstr("No such file")));
  EXPECT_THAT(messageOf<InputError>([&] { sha256OfFile(folder.path()); }),
              ::testing::HasSubstr("cannot be read"));
}

}  // namespace
}  // namespace roomgraph::test
