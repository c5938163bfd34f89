// SPDX-License-Identifier: BSD-3-Clause
// Serialisation of records into a gzip stream with checks for write errors.
#include "roomgraph/observations/rawlog_writer.h"

#include <mrpt/io/CMemoryStream.h>
#include <mrpt/serialization/CArchive.h>
#include <zlib.h>

#include <cerrno>

#include "roomgraph/core/output_file.h"

namespace roomgraph {

struct RawlogWriter::Impl {
  explicit Impl(const std::filesystem::path& rawlog) : place(rawlog), pending(rawlog) {
    file = gzopen(pending.path().c_str(), "wb1");
    if (!file) failToWrite(place, errno);
  }
  ~Impl() {
    if (file) gzclose(file);
  }
  std::filesystem::path place;
  PendingFile pending;
  gzFile file = nullptr;
};

RawlogWriter::RawlogWriter(const std::filesystem::path& rawlog) : impl_(std::make_unique<Impl>(rawlog)) {}
RawlogWriter::~RawlogWriter() = default;
RawlogWriter::RawlogWriter(RawlogWriter&&) noexcept = default;
RawlogWriter& RawlogWriter::operator=(RawlogWriter&&) noexcept = default;

void RawlogWriter::write(const mrpt::serialization::CSerializable& record) {
  mrpt::io::CMemoryStream stream;
  mrpt::serialization::archiveFrom(stream) << record;
  write({static_cast<const char*>(stream.getRawBufferData()),
         static_cast<std::size_t>(stream.getTotalBytesCount())});
}

void RawlogWriter::write(std::string_view bytes) {
  errno = 0;
  if (!bytes.empty() && gzwrite(impl_->file, bytes.data(), static_cast<unsigned>(bytes.size())) <= 0)
    failToWrite(impl_->place, errno);
}

void RawlogWriter::close() {
  errno = 0;
  const int code = gzclose(impl_->file);
  impl_->file = nullptr;
  if (code != Z_OK) failToWrite(impl_->place, errno);
  flushToDisk(impl_->pending.path());
}

void RawlogWriter::commit() {
  impl_->pending.commit();
}

void RawlogWriter::finish() {
  close();
  commit();
}

}  // namespace roomgraph
