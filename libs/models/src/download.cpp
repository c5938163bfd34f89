// SPDX-License-Identifier: BSD-3-Clause
// HTTP transfer through libcurl, with resumption by ranges.
#include "download.h"

#include <curl/curl.h>

#include <exception>
#include <memory>

namespace roomgraph {
namespace {

constexpr long kConnect_s = 30;     // until there is a connection
constexpr long kStandstill_s = 60;  // without a byte

struct Release {
  void operator()(CURL* curl) const { curl_easy_cleanup(curl); }
};

// One request and what has come of it.
struct Transfer {
  const KnownFile& file;
  PartialFile& partial;
  FetchListener& listener;
  std::unique_ptr<CURL, Release> curl;
  bool begun = false;
  std::exception_ptr failure;  // exceptions do not pass through libcurl
  char cause[CURL_ERROR_SIZE] = "";

  long status() const {
    long code = 0;
    curl_easy_getinfo(curl.get(), CURLINFO_RESPONSE_CODE, &code);
    return code;
  }

  void receive(std::string_view bytes) {
    if (!begun && status() != 206) partial.clear();  // all of it, from the beginning
    begun = true;
    if (partial.bytes() + bytes.size() > file.bytes) {
      partial.clear();
      throw RunError("is larger than the " + std::to_string(file.bytes) +
                     " bytes of the catalogue; nothing was kept");
    }
    partial.append(bytes);
    listener.progressed(partial.bytes());
  }
};

std::size_t onBytes(char* bytes, std::size_t, std::size_t count, void* user) {
  auto& transfer = *static_cast<Transfer*>(user);
  try {
    transfer.receive({bytes, count});
    return count;
  } catch (...) {
    transfer.failure = std::current_exception();
    return count + 1;  // tells libcurl to end
  }
}

int onProgress(void* user, curl_off_t, curl_off_t, curl_off_t, curl_off_t) {
  return static_cast<Transfer*>(user)->listener.cancelled() ? 1 : 0;
}

template <class Value>
void set(CURL* curl, CURLoption option, Value value) {
  if (curl_easy_setopt(curl, option, value) != CURLE_OK)
    throw RunError("libcurl lacks what is needed for downloads");
}

void prepare(Transfer& transfer, const std::string& url) {
  static const CURLcode ready = curl_global_init(CURL_GLOBAL_DEFAULT);
  transfer.curl.reset(ready == CURLE_OK ? curl_easy_init() : nullptr);
  CURL* curl = transfer.curl.get();
  if (!curl) throw RunError("libcurl cannot be started");
  set(curl, CURLOPT_URL, url.c_str());
  set(curl, CURLOPT_PROTOCOLS_STR, "http,https");
  set(curl, CURLOPT_REDIR_PROTOCOLS_STR, "http,https");
  set(curl, CURLOPT_FOLLOWLOCATION, 1L);
  set(curl, CURLOPT_MAXREDIRS, 10L);
  set(curl, CURLOPT_FAILONERROR, 1L);
  set(curl, CURLOPT_CONNECTTIMEOUT, kConnect_s);
  set(curl, CURLOPT_LOW_SPEED_LIMIT, 1L);
  set(curl, CURLOPT_LOW_SPEED_TIME, kStandstill_s);
  set(curl, CURLOPT_USERAGENT, "roomgraph");
  set(curl, CURLOPT_ERRORBUFFER, transfer.cause);
  set(curl, CURLOPT_WRITEFUNCTION, onBytes);
  set(curl, CURLOPT_WRITEDATA, &transfer);
  set(curl, CURLOPT_NOPROGRESS, 0L);
  set(curl, CURLOPT_XFERINFOFUNCTION, onProgress);
  set(curl, CURLOPT_XFERINFODATA, &transfer);
  if (transfer.partial.bytes() > 0)
    set(curl, CURLOPT_RANGE, (std::to_string(transfer.partial.bytes()) + "-").c_str());
}

std::string kept(const Transfer& transfer) {
  const std::uint64_t bytes = transfer.partial.bytes();
  if (bytes == 0) return "";
  return "; " + std::to_string(bytes) + " of " + std::to_string(transfer.file.bytes) +
         " bytes are kept, the same command goes on from there";
}

[[noreturn]] void rethrow(const Transfer& transfer, const std::string& url) {
  try {
    std::rethrow_exception(transfer.failure);
  } catch (const RunError& error) {
    throw RunError(url + ": " + error.what());
  }
}

// All that the server sent is here; is it the file?
void requireWhole(const Transfer& transfer, const std::string& url) {
  if (transfer.partial.bytes() == transfer.file.bytes) return;
  curl_off_t announced = -1;
  curl_easy_getinfo(transfer.curl.get(), CURLINFO_CONTENT_LENGTH_DOWNLOAD_T, &announced);
  if (announced < 0) throw InputError(url + ": the transfer ended early" + kept(transfer));
  const std::string bytes = std::to_string(transfer.partial.bytes());
  transfer.partial.clear();
  throw RunError(url + ": has " + bytes + " bytes instead of the " + std::to_string(transfer.file.bytes) +
                 " of the catalogue; nothing was kept");
}

}  // namespace

bool download(const std::string& url, const KnownFile& file, PartialFile& partial, FetchListener& listener) {
  if (partial.bytes() == file.bytes) return true;
  if (partial.bytes() > file.bytes) partial.clear();
  Transfer transfer{file, partial, listener, nullptr, false, nullptr, ""};
  prepare(transfer, url);
  const bool resumed = partial.bytes() > 0;
  const CURLcode result = curl_easy_perform(transfer.curl.get());
  const long status = transfer.status();
  if (transfer.failure) rethrow(transfer, url);
  if (result == CURLE_ABORTED_BY_CALLBACK) throw Interrupted(url + ": interrupted" + kept(transfer));
  if (result == CURLE_HTTP_RETURNED_ERROR && (status == 404 || status == 410)) return false;
  if (result == CURLE_HTTP_RETURNED_ERROR && status == 416 && resumed) {
    partial.clear();  // the server's file is shorter than what is here
    return download(url, file, partial, listener);
  }
  if (result == CURLE_HTTP_RETURNED_ERROR)
    throw Refused(url + ": the server answers " + std::to_string(status) + kept(transfer));
  if (result != CURLE_OK)
    throw InputError(url + ": " + (*transfer.cause ? transfer.cause : curl_easy_strerror(result)) +
                     kept(transfer));
  requireWhole(transfer, url);
  return true;
}

}  // namespace roomgraph
