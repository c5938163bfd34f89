// SPDX-License-Identifier: BSD-3-Clause
// Placeholders of page.html replaced in one pass.
#include "page.h"

#include <array>
#include <stdexcept>
#include <string_view>
#include <utility>

#include "page_text.h"

namespace roomgraph {

std::string pageAround(const std::string& json) {
  const std::array<std::pair<std::string_view, std::string_view>, 3> parts{
      {{"/*STYLES*/", kPageStyles}, {"/*DATA*/", json}, {"/*SCRIPTS*/", kPageScripts}}};
  std::string page;
  page.reserve(kPageText.size() + kPageStyles.size() + kPageScripts.size() + json.size());
  std::size_t at = 0;
  for (const auto& [mark, text] : parts) {
    const std::size_t found = kPageText.find(mark, at);
    if (found == std::string_view::npos) throw std::logic_error("the page has no " + std::string(mark));
    page.append(kPageText, at, found - at).append(text);
    at = found + mark.size();
  }
  return page.append(kPageText, at);
}

}  // namespace roomgraph
