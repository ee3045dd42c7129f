// SPDX-License-Identifier: Apache-2.0
// OpenEXR pictures; the only file that includes the library.
#include <Iex.h>
#include <ImfChannelList.h>
#include <ImfFrameBuffer.h>
#include <ImfHeader.h>
#include <ImfIO.h>
#include <ImfInputFile.h>
#include <ImfOutputFile.h>
#include <ImfStringAttribute.h>
#include <fmt/format.h>

#include <algorithm>
#include <cstring>
#include <new>
#include <set>
#include <string_view>

#include "core/base/error.h"
#include "core/io/content_seal.h"
#include "core/io/exr_header.h"
#include "core/io/file.h"
#include "core/io/image_file.h"

namespace beam {
namespace {

constexpr int kRowsAtOnce = 256;  // of a block's 32 a whole number

class MemoryIn final : public Imf::IStream {
 public:
  MemoryIn(const std::string& name, std::span<const std::byte> bytes)
      : IStream(name.c_str()), bytes_(bytes) {}
  bool read(char c[], int n) override {
    // The position comes from the file and may lie anywhere: no sum of it with `n`, which could wrap.
    if (n < 0 || at_ > bytes_.size() || static_cast<std::size_t>(n) > bytes_.size() - at_)
      throw std::runtime_error("the file ends early");
    std::memcpy(c, bytes_.data() + at_, static_cast<std::size_t>(n));
    at_ += static_cast<std::size_t>(n);
    return at_ < bytes_.size();
  }
  std::uint64_t tellg() override { return at_; }
  void seekg(std::uint64_t pos) override { at_ = static_cast<std::size_t>(pos); }

 private:
  std::span<const std::byte> bytes_;
  std::size_t at_ = 0;
};

// The library writes in its destructors, too, and swallows there what is thrown: what failed is remembered.
class MemoryOut final : public Imf::OStream {
 public:
  MemoryOut() : OStream("memory") {}
  void write(const char c[], int n) override {
    try {
      if (at_ + static_cast<std::size_t>(n) > bytes.size()) bytes.resize(at_ + static_cast<std::size_t>(n));
    } catch (...) {
      failed = true;
      throw;
    }
    std::memcpy(bytes.data() + at_, c, static_cast<std::size_t>(n));
    at_ += static_cast<std::size_t>(n);
  }
  std::uint64_t tellp() override { return at_; }
  void seekp(std::uint64_t pos) override { at_ = static_cast<std::size_t>(pos); }
  std::vector<std::byte> bytes;
  bool failed = false;

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
  const std::vector<std::byte> bytes = readFile(path, 1ull << 31);
  checkExrHeader(bytes, path);
  for (bool again = false;; again = true) {
    try {
      MemoryIn stream(path.string(), bytes);
      Imf::InputFile file(stream, 0);
      return body(file);
    } catch (const Error&) {
      throw;
    } catch (const std::bad_alloc&) {
      throw;
    } catch (const std::exception& e) {
      // The library words a lack of memory in its own ways; what was short may not be a second time.
      const std::string_view words = e.what();
      if (words.find("alloc") != std::string_view::npos) throw std::bad_alloc();
      if (again) bad(path, fmt::format("the OpenEXR picture cannot be read: {}", words));
    }
  }
}

std::size_t bytesOf(ExrPrecision precision) { return precision == ExrPrecision::Half ? 2 : 4; }

std::vector<std::string> namesIn(const Imf::Header& header) {
  std::vector<std::string> names;
  for (auto i = header.channels().begin(); i != header.channels().end(); ++i) names.emplace_back(i.name());
  return names;
}

// The stored channels for `wanted`: of these very names, else of the only layer that has them all ("env.R").
std::vector<std::string> storedNames(const std::vector<std::string>& names,
                                     const std::vector<std::string>& wanted,
                                     const std::filesystem::path& path) {
  const std::set<std::string> stored(names.begin(), names.end());
  const auto of = [&](const std::string& layer) {
    std::vector<std::string> found;
    for (const std::string& w : wanted) {
      if (stored.contains(layer + w)) found.push_back(layer + w);
    }
    return found;
  };
  if (of("").size() == wanted.size()) return wanted;
  std::set<std::string> layers;
  for (const std::string& n : names) {
    const std::string layer = n.substr(0, n.rfind('.') + 1);
    if (!layer.empty() && of(layer).size() == wanted.size()) layers.insert(layer);
  }
  if (layers.size() == 1) return of(*layers.begin());
  const bool chroma = stored.contains("RY") || stored.contains("BY");
  bad(path, fmt::format("expected channels {}, found {}{}{}", fmt::join(wanted, " "), fmt::join(names, " "),
                        layers.empty() ? "" : "; more than one layer has them: save one layer",
                        chroma ? "; the picture is luminance-chroma: save it as RGB" : ""));
}

}  // namespace

std::vector<std::string> exrChannels(const std::filesystem::path& path) {
  return withExr(path, [](Imf::InputFile& file) { return namesIn(file.header()); });
}

Planes readExr(const std::filesystem::path& path, const std::vector<std::string>& channels) {
  return withExr(path, [&](Imf::InputFile& file) {
    const Imath::Box2i window = file.header().dataWindow(), display = file.header().displayWindow();
    const int w = display.max.x - display.min.x + 1, h = display.max.y - display.min.y + 1;
    const int dw = window.max.x - window.min.x + 1, dh = window.max.y - window.min.y + 1;
    const std::vector<std::string> stored = storedNames(namesIn(file.header()), channels, path);
    Planes data(dw, dh, static_cast<int>(channels.size()));
    Imf::FrameBuffer frame;
    for (std::size_t c = 0; c < channels.size(); ++c) {
      const std::string& name = stored[c];
      const Imf::Channel* channel = file.header().channels().findChannel(name.c_str());
      if (channel->xSampling != 1 || channel->ySampling != 1) {
        bad(path, fmt::format("channel {} is subsampled (luminance-chroma); save the picture as RGB", name));
      }
      char* base = reinterpret_cast<char*>(data.plane(static_cast<int>(c))) -
                   (static_cast<std::ptrdiff_t>(window.min.y) * dw + window.min.x) * std::ptrdiff_t{4};
      frame.insert(name.c_str(), Imf::Slice(Imf::FLOAT, base, 4, static_cast<std::size_t>(dw) * 4));
    }
    file.setFrameBuffer(frame);
    file.readPixels(window.min.y, window.max.y);
    if (window == display) return data;
    Planes out(w, h, data.channels);
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

namespace {

// Of a picture that is being written: its header, and its channels in the precision of the file.
struct Encoded {
  Imf::Header header;
  Imf::FrameBuffer frame;
  std::vector<half> halves;  // `frame` points into it
};

Encoded encoded(int width, int height, std::span<const ExrChannel> channels, const FileNotes& notes) {
  const std::size_t plane = static_cast<std::size_t>(width) * height;
  const auto halves_of = std::count_if(channels.begin(), channels.end(),
                                       [](const ExrChannel& c) { return c.precision == ExrPrecision::Half; });
  Encoded e{Imf::Header(width, height), {}, {}};
  e.header.compression() = Imf::PIZ_COMPRESSION;
  for (const auto& [name, text] : sealable(notes)) e.header.insert(name, Imf::StringAttribute(text));
  e.halves.reserve(plane * static_cast<std::size_t>(halves_of));
  for (const ExrChannel& c : channels) {
    if (e.header.channels().findChannel(c.name.c_str()))
      throw Error(Error::Kind::Bug, fmt::format("two channels of an EXR picture are named {}", c.name));
    const bool is_half = c.precision == ExrPrecision::Half;
    const Imf::PixelType type = is_half ? Imf::HALF : Imf::FLOAT;
    e.header.channels().insert(c.name.c_str(), Imf::Channel(type));
    char* base = reinterpret_cast<char*>(const_cast<float*>(c.values));
    if (is_half) {
      base = reinterpret_cast<char*>(e.halves.data() + e.halves.size());
      e.halves.insert(e.halves.end(), c.values, c.values + plane);
    }
    const std::size_t bytes = bytesOf(c.precision);
    e.frame.insert(c.name.c_str(), Imf::Slice(type, base, bytes, bytes * static_cast<std::size_t>(width)));
  }
  return e;
}

// Whether the library finds each of its blocks.
bool isWhole(std::span<const std::byte> bytes) {
  MemoryIn stream("memory", bytes);
  return Imf::InputFile(stream, 0).isComplete();
}

}  // namespace

void writeExr(const std::filesystem::path& path, int width, int height, std::span<const ExrChannel> channels,
              const FileNotes& notes, const Progress* progress) {
  std::size_t pixel_bytes = 0;
  for (const ExrChannel& c : channels) pixel_bytes += bytesOf(c.precision);
  requireExrSize(width, height, channels.size(), pixel_bytes, path);
  MemoryOut stream;
  const Encoded e = encoded(width, height, channels, notes);
  // The picture and the stream are ours and sound: what the library complains of is a lack of memory, which
  // it wraps into exceptions of its own or, in a destructor, swallows.
  try {
    {
      Imf::OutputFile file(stream, e.header, 0);
      file.setFrameBuffer(e.frame);
      for (int y = 0; y < height; y += kRowsAtOnce) {
        if (progress) progress->check();
        file.writePixels(std::min(kRowsAtOnce, height - y));
      }
    }
    if (stream.failed || !isWhole(stream.bytes)) throw std::bad_alloc();
  } catch (const Iex::BaseExc&) {
    throw std::bad_alloc();
  }
  seal(stream.bytes);
  writeFileAtomically(path, stream.bytes);
}

void writeExr(const std::filesystem::path& path, const Planes& planes,
              const std::vector<std::string>& channels, ExrPrecision precision, const FileNotes& notes) {
  if (channels.size() != static_cast<std::size_t>(planes.channels)) {
    throw Error(Error::Kind::Bug, "as many channel names as planes are needed to write an EXR picture");
  }
  std::vector<ExrChannel> named;
  for (int c = 0; c < planes.channels; ++c) named.push_back({channels[c], precision, planes.plane(c)});
  writeExr(path, planes.width, planes.height, named, notes);
}

}  // namespace beam
