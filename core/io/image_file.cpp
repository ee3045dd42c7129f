// SPDX-License-Identifier: Apache-2.0
// PNG and JPEG through OpenCV, after our own look at the header; .exr and .hdr live in files of their own.
#include "core/io/image_file.h"

#include <fmt/format.h>
#include <zlib.h>

#include <cstring>
#include <new>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>

#include "core/base/error.h"
#include "core/base/log.h"
#include "core/base/word_list.h"
#include "core/io/content_seal.h"
#include "core/io/file.h"
#include "core/io/radiance_file.h"

namespace beam {
namespace {

constexpr std::uint64_t kMaxFile = 1ull << 30;
constexpr int kMaxSide = 16384;
constexpr std::int64_t kMaxPixels = std::int64_t{1} << 27;
constexpr std::int64_t kMaxExpansion = 1100;  // deflate's own limit is about 1030 : 1

using Bytes = std::vector<std::byte>;

[[noreturn]] void bad(const std::filesystem::path& path, const std::string& what) {
  throw Error(Error::Kind::Data, fmt::format("\"{}\": {}", path.string(), what));
}

unsigned at(const Bytes& b, std::size_t i) { return std::to_integer<unsigned>(b[i]); }
unsigned big16(const Bytes& b, std::size_t i) { return at(b, i) << 8 | at(b, i + 1); }
unsigned big32(const Bytes& b, std::size_t i) { return big16(b, i) << 16 | big16(b, i + 2); }

bool isPng(const Bytes& b) {
  constexpr unsigned char kMagic[8] = {0x89, 'P', 'N', 'G', 13, 10, 26, 10};
  return b.size() >= 33 && std::memcmp(b.data(), kMagic, 8) == 0;
}
bool isJpeg(const Bytes& b) { return b.size() >= 4 && at(b, 0) == 0xff && at(b, 1) == 0xd8; }

ImageSize jpegSize(const Bytes& b, const std::filesystem::path& path) {
  for (std::size_t i = 2; i + 9 < b.size();) {
    if (at(b, i) != 0xff) break;
    const unsigned marker = at(b, i + 1);
    if (marker == 0xff) {
      ++i;
      continue;
    }
    const bool frame = marker >= 0xc0 && marker <= 0xcf && marker != 0xc4 && marker != 0xc8 && marker != 0xcc;
    if (frame) return {static_cast<int>(big16(b, i + 7)), static_cast<int>(big16(b, i + 5)), false};
    const unsigned length = big16(b, i + 2);
    if (length < 2) break;
    i += 2 + length;
  }
  bad(path, "expected a JPEG frame header with the picture's size, found none; the file is damaged");
}

ImageSize sizeOf(const Bytes& b, const std::filesystem::path& path) {
  if (b.empty()) bad(path, "the file is empty");
  if (isPng(b)) {
    const unsigned w = big32(b, 16), h = big32(b, 20), type = at(b, 25);
    if (w > 0x7fffffffu || h > 0x7fffffffu) bad(path, "the PNG header gives an impossible size");
    return {static_cast<int>(w), static_cast<int>(h), type == 4 || type == 6};
  }
  if (isJpeg(b)) return jpegSize(b, path);
  bad(path, "expected a PNG or JPEG picture, found something else");
}

void checkSize(const ImageSize& s, const Bytes& b, const std::filesystem::path& path) {
  const std::int64_t pixels = std::int64_t{s.width} * s.height;
  if (s.width < 1 || s.height < 1 || s.width > kMaxSide || s.height > kMaxSide || pixels > kMaxPixels) {
    bad(path, fmt::format("expected 1 to {} pixels a side and at most {} in all, the header says {} x {}",
                          kMaxSide, kMaxPixels, s.width, s.height));
  }
  if (pixels / 8 > static_cast<std::int64_t>(b.size()) * kMaxExpansion) {
    bad(path, fmt::format("the header says {} x {} pixels, which {} bytes cannot hold; the file is damaged",
                          s.width, s.height, b.size()));
  }
}

// A chunk that pixels are made of, whose checksum (of type and data) decoders insist on; of the others they
// only complain.
bool isBroken(const Bytes& b, std::size_t chunk, std::uint64_t length) {
  const bool critical = (at(b, chunk + 4) & 0x20) == 0;  // PNG specification 5.4: an upper-case letter
  const auto* type = reinterpret_cast<const unsigned char*>(b.data() + chunk + 4);
  return critical && ::crc32_z(0, type, length + 4) != big32(b, chunk + 8 + length);
}

// Whether the chunks of a PNG follow one another up to its end chunk. Throws Error{Data} for a broken one,
// before the decoder prints of it.
bool pngEnds(const Bytes& b, const std::filesystem::path& path) {
  for (std::size_t i = 8; b.size() - i >= 12;) {
    const std::uint64_t length = big32(b, i);
    if (length > b.size() - i - 12) return false;
    if (isBroken(b, i, length)) {
      bad(path,
          fmt::format("the picture cannot be decoded; the file is damaged near byte {}, copy it again", i));
    }
    if (std::memcmp(&b[i + 4], "IEND", 4) == 0) return true;
    i += length + 12;
  }
  return false;
}

// Whether the last scan of a JPEG is followed by its end marker; the one of a thumbnail in the header does
// not count.
bool jpegEnds(const Bytes& b) {
  bool in_scan = false;
  for (std::size_t i = 2; i + 1 < b.size();) {
    const unsigned marker = at(b, i + 1);
    const bool data = at(b, i) != 0xff || marker == 0 || marker == 0xff || (marker >= 0xd0 && marker <= 0xd7);
    if (data) {
      if (!in_scan && at(b, i) != 0xff) return false;
      ++i;
    } else if (marker == 0xd9) {
      return in_scan;
    } else {
      if (i + 3 >= b.size()) return false;
      in_scan = marker == 0xda || in_scan;
      i += 2 + big16(b, i + 2);
    }
  }
  return false;
}

// Decoders hand out half a picture for a truncated file: the end must be there.
void checkEnd(const Bytes& b, const std::filesystem::path& path) {
  const bool png = isPng(b);
  if (png ? pngEnds(b, path) : jpegEnds(b)) return;
  bad(path, fmt::format("expected the end of a {} picture, found none; the file is truncated, copy it again",
                        png ? "PNG" : "JPEG"));
}

// Empty: damaged, or there was too little memory, which the decoders do not tell apart.
cv::Mat decodeOnce(const Bytes& b, const std::filesystem::path& path) {
  try {
    return cv::imdecode(cv::Mat(1, static_cast<int>(b.size()), CV_8U, const_cast<std::byte*>(b.data())),
                        cv::IMREAD_UNCHANGED);
  } catch (const cv::Exception& e) {
    if (e.code == cv::Error::StsNoMem) throw std::bad_alloc();
    bad(path, fmt::format("the picture cannot be decoded: {}", e.err));
  }
}

// Throws std::bad_alloc where not even as much can be had as decoding a picture of that size takes.
void requireRoomFor(const ImageSize& size) {
  constexpr std::size_t kBytesOfAPixel = 8 + 8;  // four channels of 16 bits, once as stored and once decoded
  const std::size_t bytes = kBytesOfAPixel * static_cast<std::size_t>(size.width) * size.height;
  ::operator delete(::operator new(bytes));  // by these names, which the compiler does not take out
}

// 8 bits a channel; as many channels as stored, in OpenCV's order.
cv::Mat decode(const std::filesystem::path& path) {
  const Bytes b = readFile(path, kMaxFile);
  const ImageSize size = sizeOf(b, path);
  checkSize(size, b, path);
  checkEnd(b, path);
  cv::Mat m = decodeOnce(b, path);
  if (m.empty()) {
    requireRoomFor(size);
    m = decodeOnce(b, path);  // what was short then may not be now
  }
  if (m.empty()) bad(path, "the picture cannot be decoded; the file is damaged");
  if (m.depth() == CV_16U) m.convertTo(m, CV_8U, 255.0 / 65535.0);
  if (m.depth() != CV_8U) bad(path, "expected 8 or 16 bits a channel");
  return m;
}

Image<std::uint8_t> channelOf(const cv::Mat& m, int channel) {
  Image<std::uint8_t> out(m.cols, m.rows);
  const int channels = m.channels();
  for (int y = 0; y < m.rows; ++y) {
    const std::uint8_t* row = m.ptr<std::uint8_t>(y);
    for (int x = 0; x < m.cols; ++x) out(x, y) = row[x * channels + channel];
  }
  return out;
}

cv::Mat matOf(const Image<u8vec3>& image) {
  cv::Mat m(image.height, image.width, CV_8UC3);
  for (int y = 0; y < image.height; ++y) {
    for (int x = 0; x < image.width; ++x) {
      const u8vec3 p = image(x, y);
      m.at<cv::Vec3b>(y, x) = cv::Vec3b(p.z, p.y, p.x);
    }
  }
  return m;
}

void appendBigEndian(std::vector<unsigned char>& out, std::uint32_t value) {
  for (int shift = 24; shift >= 0; shift -= 8) out.push_back(static_cast<unsigned char>(value >> shift));
}

// Length, type, data, CRC of type and data (PNG specification 5.3).
void appendPngChunk(std::vector<unsigned char>& out, const std::string& type, const std::string& data) {
  appendBigEndian(out, static_cast<std::uint32_t>(data.size()));
  const std::string content = type + data;
  out.insert(out.end(), content.begin(), content.end());
  appendBigEndian(out, static_cast<std::uint32_t>(::crc32_z(
                           0, reinterpret_cast<const unsigned char*>(content.data()), content.size())));
}

// The pictures are ours: nothing but memory can be short, which the encoders word in many ways.
std::vector<unsigned char> encoded(const char* ending, const cv::Mat& m, const std::vector<int>& how = {}) {
  std::vector<unsigned char> bytes;
  try {
    if (cv::imencode(ending, m, bytes, how)) return bytes;
  } catch (const cv::Exception& e) {
    logDebug("a {} picture could not be encoded: {}", ending + 1, e.err);
  }
  throw std::bad_alloc();
}

void writeEncoded(const std::filesystem::path& path, const cv::Mat& m, bool srgb, const FileNotes& notes) {
  constexpr std::size_t kHeaderEnd = 8 + 25;  // signature and IHDR, which comes first
  std::vector<unsigned char> bytes = encoded(".png", m);
  std::vector<unsigned char> chunks;
  if (srgb && !notes.empty()) appendPngChunk(chunks, "sRGB", std::string(1, '\0'));  // perceptual intent
  for (const auto& [name, text] : sealable(notes)) appendPngChunk(chunks, "tEXt", name + '\0' + text);
  bytes.insert(bytes.begin() + kHeaderEnd, chunks.begin(), chunks.end());
  seal(std::as_writable_bytes(std::span(bytes)));
  writeFileAtomically(path, std::as_bytes(std::span(bytes)));
}

}  // namespace

ImageSize readImageSize(const std::filesystem::path& path) {
  const Bytes b = readFile(path, kMaxFile);
  const ImageSize s = sizeOf(b, path);
  checkSize(s, b, path);
  return s;
}

ImageSize checkImageFile(const std::filesystem::path& path) {
  const Bytes b = readFile(path, kMaxFile);
  const ImageSize s = sizeOf(b, path);
  checkSize(s, b, path);
  checkEnd(b, path);
  return s;
}

Image<u8vec3> readPhoto(const std::filesystem::path& path) {
  const cv::Mat m = decode(path);
  const int channels = m.channels();
  Image<u8vec3> out(m.cols, m.rows, u8vec3(0), Encoding::Srgb);
  for (int y = 0; y < m.rows; ++y) {
    const std::uint8_t* row = m.ptr<std::uint8_t>(y);
    for (int x = 0; x < m.cols; ++x) {
      const std::uint8_t* p = row + x * channels;
      out(x, y) = channels < 3 ? u8vec3(p[0]) : u8vec3(p[2], p[1], p[0]);
    }
  }
  return out;
}

Image<std::uint8_t> readMask(const std::filesystem::path& path) {
  const cv::Mat m = decode(path);
  return channelOf(m, m.channels() < 3 ? 0 : 2);
}

Image<std::uint8_t> readAlpha(const std::filesystem::path& path) {
  const cv::Mat m = decode(path);
  // OpenCV turns gray with alpha into four channels.
  if (m.channels() != 4) bad(path, "expected a picture with an alpha channel");
  return channelOf(m, 3);
}

const std::vector<std::string_view>& unreadPictureEndings() {
  static const std::vector<std::string_view> all = {".tif",  ".tiff", ".bmp", ".webp", ".avif",
                                                    ".heic", ".jxl",  ".jp2", ".dng",  ".cr2",
                                                    ".cr3",  ".nef",  ".arw", ".raw"};
  return all;
}

const std::vector<std::string_view>& videoEndings() {
  static const std::vector<std::string_view> all = {".mp4", ".mov", ".mkv", ".avi"};
  return all;
}

bool isRadianceName(const std::filesystem::path& path) {
  const std::string extension = lowerCase(path.extension().string());
  return extension == ".exr" || extension == ".hdr" || extension == ".pic";
}

bool isGrayExr(const std::filesystem::path& path) {
  if (lowerCase(path.extension().string()) != ".exr") return false;
  const std::vector<std::string> stored = exrChannels(path);
  return stored == std::vector<std::string>{"Y"} || stored == std::vector<std::string>{"A", "Y"};
}

Image<vec3> readRadiance(const std::filesystem::path& path) {
  if (!isRadianceName(path)) bad(path, "expected a panorama as .exr or .hdr");
  if (lowerCase(path.extension().string()) != ".exr") return readRadianceHdr(path);
  const bool gray = isGrayExr(path);
  const Planes p =
      readExr(path, gray ? std::vector<std::string>{"Y"} : std::vector<std::string>{"R", "G", "B"});
  Image<vec3> out(p.width, p.height, vec3(0), Encoding::Linear);
  for (std::size_t i = 0; i < out.pixels.size(); ++i) {
    out.pixels[i] = gray ? vec3(p.plane(0)[i]) : vec3(p.plane(0)[i], p.plane(1)[i], p.plane(2)[i]);
  }
  return out;
}

void writePng(const std::filesystem::path& path, const Image<u8vec3>& image, const FileNotes& notes) {
  writeEncoded(path, matOf(image), image.encoding == Encoding::Srgb, notes);
}

std::vector<std::byte> encodeJpeg(const Image<u8vec3>& image, int quality) {
  const std::vector<unsigned char> bytes = encoded(".jpg", matOf(image), {cv::IMWRITE_JPEG_QUALITY, quality});
  const auto all = std::as_bytes(std::span(bytes));
  return {all.begin(), all.end()};
}

void writePng(const std::filesystem::path& path, const Image<std::uint8_t>& image, const FileNotes& notes) {
  const cv::Mat m(image.height, image.width, CV_8UC1, const_cast<std::uint8_t*>(image.pixels.data()));
  writeEncoded(path, m, false, notes);
}

void writePng(const std::filesystem::path& path, const Image<u8vec4>& image, const FileNotes& notes) {
  const cv::Mat rgba(image.height, image.width, CV_8UC4, const_cast<u8vec4*>(image.pixels.data()));
  cv::Mat bgra;
  cv::cvtColor(rgba, bgra, cv::COLOR_RGBA2BGRA);
  writeEncoded(path, bgra, image.encoding == Encoding::Srgb, notes);
}

}  // namespace beam
