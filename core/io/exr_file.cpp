// SPDX-License-Identifier: Apache-2.0
// OpenEXR pictures; the only file that includes the library.
#include <ImfChannelList.h>
#include <ImfFrameBuffer.h>
#include <ImfHeader.h>
#include <ImfIO.h>
#include <ImfInputFile.h>
#include <ImfOutputFile.h>
#include <fmt/format.h>

#include <algorithm>
#include <cstring>

#include "core/base/error.h"
#include "core/io/file.h"
#include "core/io/image_file.h"

namespace beam {
namespace {

constexpr int kMaxSide = 16384;
constexpr std::int64_t kMaxPixels = std::int64_t{1} << 27;

class MemoryIn final : public Imf::IStream {
 public:
  MemoryIn(const std::string& name, std::vector<std::byte> bytes)
      : IStream(name.c_str()), bytes_(std::move(bytes)) {}
  bool read(char c[], int n) override {
    if (n < 0 || at_ + static_cast<std::size_t>(n) > bytes_.size())
      throw std::runtime_error("the file ends early");
    std::memcpy(c, bytes_.data() + at_, static_cast<std::size_t>(n));
    at_ += static_cast<std::size_t>(n);
    return at_ < bytes_.size();
  }
  std::uint64_t tellg() override { return at_; }
  void seekg(std::uint64_t pos) override { at_ = static_cast<std::size_t>(pos); }

 private:
  std::vector<std::byte> bytes_;
  std::size_t at_ = 0;
};

class MemoryOut final : public Imf::OStream {
 public:
  MemoryOut() : OStream("memory") {}
  void write(const char c[], int n) override {
    if (at_ + static_cast<std::size_t>(n) > bytes.size()) bytes.resize(at_ + static_cast<std::size_t>(n));
    std::memcpy(bytes.data() + at_, c, static_cast<std::size_t>(n));
    at_ += static_cast<std::size_t>(n);
  }
  std::uint64_t tellp() override { return at_; }
  void seekp(std::uint64_t pos) override { at_ = static_cast<std::size_t>(pos); }
  std::vector<std::byte> bytes;

 private:
  std::size_t at_ = 0;
};

[[noreturn]] void bad(const std::filesystem::path& path, const std::string& what) {
  throw Error(Error::Kind::Data, fmt::format("\"{}\": {}", path.string(), what));
}

// Calls body(file) with the open picture; every complaint of the library becomes an Error that names the
// file.
template <class Body>
auto withExr(const std::filesystem::path& path, Body&& body) {
  std::vector<std::byte> bytes = readFile(path, 1ull << 31);
  if (bytes.empty()) bad(path, "the file is empty; expected an OpenEXR picture");
  constexpr unsigned char kMagic[4] = {0x76, 0x2f, 0x31, 0x01};
  if (bytes.size() < 8 || std::memcmp(bytes.data(), kMagic, 4) != 0) bad(path, "expected an OpenEXR picture");
  try {
    Imf::Header::setMaxImageSize(kMaxSide, kMaxSide);
    MemoryIn stream(path.string(), std::move(bytes));
    Imf::InputFile file(stream, 0);
    return body(file);
  } catch (const Error&) {
    throw;
  } catch (const std::bad_alloc&) {
    throw;
  } catch (const std::exception& e) {
    bad(path, fmt::format("the OpenEXR picture cannot be read: {}", e.what()));
  }
}

std::vector<std::string> namesIn(const Imf::Header& header) {
  std::vector<std::string> names;
  for (auto i = header.channels().begin(); i != header.channels().end(); ++i) names.emplace_back(i.name());
  return names;
}

// The stored channel for `wanted`: itself, or the only one of a layer that ends in ".wanted".
std::string storedName(const std::vector<std::string>& names, const std::string& wanted,
                       const std::filesystem::path& path) {
  std::vector<std::string> layered;
  for (const std::string& n : names) {
    if (n == wanted) return n;
    if (n.size() > wanted.size() + 1 && n.ends_with("." + wanted)) layered.push_back(n);
  }
  if (!layered.empty()) return layered.front();
  bad(path, fmt::format("expected a channel {}, found {}", wanted, fmt::join(names, " ")));
}

}  // namespace

std::vector<std::string> exrChannels(const std::filesystem::path& path) {
  return withExr(path, [](Imf::InputFile& file) { return namesIn(file.header()); });
}

Planes readExr(const std::filesystem::path& path, const std::vector<std::string>& channels) {
  return withExr(path, [&](Imf::InputFile& file) {
    const Imath::Box2i window = file.header().dataWindow(), display = file.header().displayWindow();
    const std::int64_t w = std::int64_t{display.max.x} - display.min.x + 1,
                       h = std::int64_t{display.max.y} - display.min.y + 1;
    const std::int64_t dw = std::int64_t{window.max.x} - window.min.x + 1,
                       dh = std::int64_t{window.max.y} - window.min.y + 1;
    if (std::min({w, h, dw, dh}) < 1 || std::max({w, h, dw, dh}) > kMaxSide ||
        std::max(w * h, dw * dh) > kMaxPixels) {
      bad(path, fmt::format("expected 1 to {} pixels a side, found {} x {}", kMaxSide, w, h));
    }
    const std::vector<std::string> names = namesIn(file.header());
    Planes data(static_cast<int>(dw), static_cast<int>(dh), static_cast<int>(channels.size()));
    Imf::FrameBuffer frame;
    for (std::size_t c = 0; c < channels.size(); ++c) {
      const std::string name = storedName(names, channels[c], path);
      const Imf::Channel* channel = file.header().channels().findChannel(name.c_str());
      if (channel->xSampling != 1 || channel->ySampling != 1) {
        bad(path, fmt::format("channel {} is subsampled (luminance-chroma); save the picture as RGB", name));
      }
      char* base = reinterpret_cast<char*>(data.plane(static_cast<int>(c))) -
                   (static_cast<std::ptrdiff_t>(window.min.y) * dw + window.min.x) * 4;
      frame.insert(name.c_str(), Imf::Slice(Imf::FLOAT, base, 4, static_cast<std::size_t>(dw) * 4));
    }
    file.setFrameBuffer(frame);
    file.readPixels(window.min.y, window.max.y);
    if (window == display) return data;
    Planes out(static_cast<int>(w), static_cast<int>(h), data.channels);
    for (int y = 0; y < out.height; ++y) {
      for (int x = 0; x < out.width; ++x) {
        const int sx = x + display.min.x - window.min.x, sy = y + display.min.y - window.min.y;
        if (sx < 0 || sy < 0 || sx >= dw || sy >= dh) continue;
        for (int c = 0; c < out.channels; ++c) {
          out.plane(c)[static_cast<std::size_t>(y) * out.width + x] =
              data.plane(c)[static_cast<std::size_t>(sy) * dw + sx];
        }
      }
    }
    return out;
  });
}

void writeExr(const std::filesystem::path& path, const Planes& planes,
              const std::vector<std::string>& channels, ExrPrecision precision) {
  if (channels.size() != static_cast<std::size_t>(planes.channels)) {
    throw Error(Error::Kind::Bug, "as many channel names as planes are needed to write an EXR picture");
  }
  MemoryOut stream;
  {
    Imf::Header header(planes.width, planes.height);
    header.compression() = Imf::PIZ_COMPRESSION;
    const Imf::PixelType type = precision == ExrPrecision::Half ? Imf::HALF : Imf::FLOAT;
    Imf::FrameBuffer frame;
    std::vector<half> halves;
    if (precision == ExrPrecision::Half) halves.assign(planes.values.begin(), planes.values.end());
    for (int c = 0; c < planes.channels; ++c) {
      header.channels().insert(channels[c].c_str(), Imf::Channel(type));
      const std::size_t bytes = precision == ExrPrecision::Half ? 2 : 4;
      char* base = precision == ExrPrecision::Half
                       ? reinterpret_cast<char*>(halves.data() + planes.planeSize() * c)
                       : reinterpret_cast<char*>(const_cast<float*>(planes.plane(c)));
      frame.insert(channels[c].c_str(),
                   Imf::Slice(type, base, bytes, bytes * static_cast<std::size_t>(planes.width)));
    }
    Imf::OutputFile file(stream, header, 0);
    file.setFrameBuffer(frame);
    file.writePixels(planes.height);
  }
  writeFileAtomically(path, stream.bytes);
}

}  // namespace beam
