// SPDX-License-Identifier: Apache-2.0
#include "core/pipeline/checkpoint_files.h"

#include <algorithm>
#include <fstream>
#include <string_view>
#include <utility>

#include "core/base/hash.h"
#include "core/base/log.h"
#include "core/io/file.h"
#include "core/pipeline/version.h"

namespace beam {
namespace fs = std::filesystem;
namespace {

constexpr const char* kNewest = "newest";
constexpr const char* kOlder = "older";
constexpr std::size_t kPiece = 4u << 20;  // between two looks for a stop
constexpr int kShareOfTime = 50;          // one in so many parts may go into keeping

struct Header {
  Digest program = digestOf(std::string_view(kProgramVersion));  // another may lay its values out otherwise
  Digest digest;                                                 // of the bytes that follow
  std::uint64_t bytes = 0;                                       // that follow
};

class FileReader final : public CheckpointReader {
 public:
  // Throws Error{Data} for what is no whole checkpoint.
  explicit FileReader(const fs::path& file) : in_(file, std::ios::binary) {
    Header header;
    std::error_code failed;
    const std::uint64_t bytes = fs::file_size(file, failed);
    if (failed || bytes < sizeof header) throw damaged("it is cut");
    left_ = bytes;
    read(std::as_writable_bytes(std::span(&header, 1)));
    if (header.program != Header().program) throw damaged("another version of the program wrote it");
    if (header.bytes != left_) throw damaged("it is cut");
    Hasher hasher;
    std::vector<std::byte> piece(std::min<std::uint64_t>(kPiece, left_));
    while (left_ > 0) {
      const auto now = std::span(piece).first(std::min<std::uint64_t>(piece.size(), left_));
      read(now);
      hasher.add(now);
    }
    if (hasher.digest() != header.digest) throw damaged("its bytes are not those that were written");
    in_.seekg(sizeof header);
    left_ = header.bytes;
  }

 protected:
  std::uint64_t left() const override { return left_; }
  void read(std::span<std::byte> bytes) override {
    if (bytes.size() > left_ ||
        !in_.read(reinterpret_cast<char*>(bytes.data()), static_cast<std::streamsize>(bytes.size())))
      throw damaged("it cannot be read to its end");
    left_ -= bytes.size();
  }

 private:
  static Error damaged(const char* why) { return {Error::Kind::Data, why}; }

  std::ifstream in_;
  std::uint64_t left_ = 0;
};

Header headerOf(std::span<const CheckpointWriter::Piece> pieces) {
  Header header;
  Hasher hasher;
  for (const CheckpointWriter::Piece& piece : pieces) {
    header.bytes += piece.size();
    hasher.add(piece);
  }
  header.digest = hasher.digest();
  return header;
}

void write(const fs::path& file, std::span<const CheckpointWriter::Piece> pieces, const Progress& progress) {
  const Header header = headerOf(pieces);
  std::vector<CheckpointWriter::Piece> todo = {std::as_bytes(std::span(&header, 1))};
  todo.insert(todo.end(), pieces.begin(), pieces.end());
  std::size_t at = 0;
  writeFileAtomically(file, [&]() -> std::string_view {
    progress.check();
    while (at < todo.size() && todo[at].empty()) ++at;
    if (at == todo.size()) return {};
    const auto now = todo[at].first(std::min(kPiece, todo[at].size()));
    todo[at] = todo[at].subspan(now.size());
    return {reinterpret_cast<const char*>(now.data()), now.size()};
  });
}

}  // namespace

CheckpointFiles::CheckpointFiles(fs::path folder, std::chrono::milliseconds every)
    : folder_(std::move(folder)), every_(every), next_(Clock::now() + every) {}

void CheckpointFiles::keep(const CheckpointWriter& what, const Progress& progress) {
  const Clock::time_point begin = Clock::now();
  try {
    fs::create_directories(folder_);
    removeHalfWritten();
    if (fs::exists(folder_ / kNewest)) fs::rename(folder_ / kNewest, folder_ / kOlder);
    write(folder_ / kNewest, what.pieces(), progress);
  } catch (const std::exception& e) {
    if (dynamic_cast<const Cancelled*>(&e)) throw;
    if (!std::exchange(warned_, true))
      logWarning("what is computed so far could not be kept, a kill would cost it: {}", e.what());
  }
  const Clock::time_point end = Clock::now();
  next_ = end + std::max<Clock::duration>(every_, kShareOfTime * (end - begin));
}

// Of a process that was killed meanwhile.
void CheckpointFiles::removeHalfWritten() const {
  for (const fs::directory_entry& entry : entriesOf(folder_))
    if (entry.path().filename().string().front() == '.') fs::remove(entry.path());
}

std::unique_ptr<CheckpointReader> CheckpointFiles::kept() const {
  for (const char* name : {kNewest, kOlder}) {
    std::error_code failed;
    if (!fs::is_regular_file(folder_ / name, failed)) continue;
    try {
      return std::make_unique<FileReader>(folder_ / name);
    } catch (const Error& e) {
      logInfo("the checkpoint \"{}\" is passed over: {}", (folder_ / name).string(), e.what());
    }
  }
  return nullptr;
}

}  // namespace beam
