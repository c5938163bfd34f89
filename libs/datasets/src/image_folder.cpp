// SPDX-License-Identifier: BSD-3-Clause
// Link from a copied rawlog to the external images of the original.
#include "image_folder.h"

#include "roomgraph/core/errors.h"

namespace roomgraph {

void linkImages(const std::filesystem::path& input, const std::filesystem::path& output) {
  const std::filesystem::path images = imageFolderOf(input), expected = imageFolderOf(output);
  std::error_code error;
  if (!std::filesystem::is_directory(images, error) || std::filesystem::equivalent(images, expected, error))
    return;
  const std::filesystem::path link = withoutEndings(std::filesystem::absolute(output)).string() + "_Images";
  std::filesystem::create_directory_symlink(std::filesystem::canonical(images), link, error);
  if (error)
    throw RunError(link.string() + ": no link to the external images in " + images.string() + ": " +
                   error.message());
}

}  // namespace roomgraph
