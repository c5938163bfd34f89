// SPDX-License-Identifier: BSD-3-Clause
// Text that is put into HTML and XML.
#include "roomgraph/core/markup.h"

#include <gtest/gtest.h>

namespace roomgraph {
namespace {

TEST(Markup, NamesWhatHasAMeaningThere) {
  EXPECT_EQ(escapedForMarkup("a<b> & \"c\""), "a&lt;b&gt; &amp; &quot;c&quot;");
  EXPECT_EQ(escapedForMarkup("Küche 'x'"), "Küche 'x'");
  EXPECT_EQ(escapedForMarkup(std::string("a\0b\x1b[1m\n", 8)), "a b [1m ");
}

}  // namespace
}  // namespace roomgraph
