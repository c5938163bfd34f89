// SPDX-License-Identifier: BSD-3-Clause
// SHA-256 through OpenSSL's libcrypto, files block by block.
#include "roomgraph/core/checksum.h"

#include <openssl/evp.h>

#include <array>
#include <cerrno>
#include <cstring>
#include <fstream>
#include <memory>
#include <vector>

#include "roomgraph/core/errors.h"

namespace roomgraph {
namespace {

class Sha256 {
 public:
  Sha256() : context_(EVP_MD_CTX_new()) {
    require(context_ && EVP_DigestInit_ex(context_.get(), EVP_sha256(), nullptr) == 1);
  }
  void add(const char* bytes, std::size_t count) {
    require(EVP_DigestUpdate(context_.get(), bytes, count) == 1);
  }
  std::string digits() {
    std::array<unsigned char, EVP_MAX_MD_SIZE> digest{};
    unsigned int length = 0;
    require(EVP_DigestFinal_ex(context_.get(), digest.data(), &length) == 1);
    std::string text;
    for (unsigned int i = 0; i < length; ++i)
      for (const unsigned int half : {digest[i] / 16u, digest[i] % 16u}) text += "0123456789abcdef"[half];
    return text;
  }

 private:
  struct Release {
    void operator()(EVP_MD_CTX* context) const { EVP_MD_CTX_free(context); }
  };
  static void require(bool done) {
    if (!done) throw RunError("OpenSSL cannot compute SHA-256");
  }
  std::unique_ptr<EVP_MD_CTX, Release> context_;
};

}  // namespace

std::string sha256Of(std::string_view bytes) {
  Sha256 sum;
  sum.add(bytes.data(), bytes.size());
  return sum.digits();
}

std::string sha256OfFile(const std::filesystem::path& file) {
  errno = 0;
  std::ifstream in(file, std::ios::binary);
  Sha256 sum;
  std::vector<char> block(1 << 16);
  while (in.read(block.data(), static_cast<std::streamsize>(block.size())) || in.gcount() > 0)
    sum.add(block.data(), static_cast<std::size_t>(in.gcount()));
  if (!in.eof()) throw InputError(file.string() + ": cannot be read: " + std::strerror(errno ? errno : EIO));
  return sum.digits();
}

}  // namespace roomgraph
