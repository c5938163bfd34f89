// SPDX-License-Identifier: BSD-3-Clause
// Base64: the test vectors of RFC 4648.
#include "roomgraph/core/base64.h"

#include <gtest/gtest.h>

#include <map>

namespace roomgraph::test {
namespace {

TEST(Base64, TestVectorsOfTheStandard) {
  const std::map<std::string, std::string> known{{"", ""},
                                                 {"f", "Zg=="},
                                                 {"fo", "Zm8="},
                                                 {"foo", "Zm9v"},
                                                 {"foob", "Zm9vYg=="},
                                                 {"fooba", "Zm9vYmE="},
                                                 {"foobar", "Zm9vYmFy"},
                                                 {"\xff\xfe", "//4="}};
  for (const auto& [bytes, text] : known) EXPECT_EQ(toBase64(bytes), text);
  for (const auto& [bytes, text] : known) EXPECT_EQ(fromBase64(text), bytes);
}

TEST(Base64, WhatIsNoneIsRefused) {
  for (const char* text : {"Z", "Zg=", "Zg", "Z===", "====", "Zm9*", "Zg==Zg=="})
    EXPECT_THROW(fromBase64(text), std::invalid_argument) << text;
}

}  // namespace
}  // namespace roomgraph::test
