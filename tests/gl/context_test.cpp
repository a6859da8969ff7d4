// SPDX-License-Identifier: BSD-3-Clause
#include "gl/context.hpp"

#include <gtest/gtest.h>

#include <cstring>
#include <numeric>
#include <vector>

#include "gl/buffer.hpp"
#include "gl/library.hpp"
#include "gl/shader.hpp"
#include "gl/texture.hpp"
#include "gl/timer.hpp"
#include "support/gl_context.hpp"

namespace tessera::gl {
namespace {

template <class Work>
scene::Error error_of(Work work) {
  try {
    work();
  } catch (const scene::Error& error) {
    return error;
  }
  ADD_FAILURE() << "no error";
  return scene::bad_input("");
}

constexpr const char* doubling = R"(
layout(local_size_x = 64) in;
layout(std430, binding = 0) buffer Numbers { uint numbers[]; };
layout(location = 0) uniform uint count;
void main() {
  if (gl_GlobalInvocationID.x < count) numbers[gl_GlobalInvocationID.x] *= 2u;
}
)";

/// Uploads 0, 1, .. n - 1, doubles the first `count` of them in a compute shader, and reads them back.
std::vector<GLuint> doubled(const Context& context, GLuint n, GLuint count) {
  const Program program(context, {{GL_COMPUTE_SHADER, {{"doubling", doubling}}}});
  Buffer upload(context, Buffer::Use::upload), work(context, Buffer::Use::device),
      readback(context, Buffer::Use::readback);
  const std::size_t bytes = n * sizeof(GLuint);
  for (Buffer* buffer : {&upload, &work, &readback}) buffer->reserve(bytes);
  std::vector<GLuint> numbers(n);
  std::iota(numbers.begin(), numbers.end(), 0u);
  std::memcpy(upload.mapped(), numbers.data(), bytes);
  work.copy_from(upload, 0, bytes);
  work.bind(0);
  program.use();
  program.set(0, count);
  context.gl().DispatchCompute((n + 63) / 64, 1, 1);
  context.gl().MemoryBarrier(GL_ALL_BARRIER_BITS);
  readback.copy_from(work, 0, bytes);
  Fence fence(context);
  fence.set();
  fence.wait();
  std::memcpy(numbers.data(), readback.mapped(), bytes);
  return numbers;
}

void expect_doubled(const Context& context) {
  const auto numbers = doubled(context, 1000, 700);
  for (GLuint i = 0; i < 1000; ++i) ASSERT_EQ(numbers[i], i < 700 ? 2 * i : i);
}

TEST(Osmesa, ComputesOnStorageBuffers) {
  TESSERA_OSMESA_OR_SKIP(context);
  EXPECT_TRUE(context.software());
  EXPECT_NE(context.name().find("OSMesa"), std::string::npos);
  expect_doubled(context);
  context.check("computing");
}

TEST(Osmesa, ContextsFollowOneAnother) {
  for (int i = 0; i < 3; ++i) {
    TESSERA_OSMESA_OR_SKIP(context);
    expect_doubled(context);
  }
}

TEST(Egl, ComputesOnADeviceWithoutASurface) {
  std::unique_ptr<Context> context;
  try {
    context = open_context(Platform::egl);
  } catch (const scene::Error& error) {
    EXPECT_EQ(error.code(), scene::ErrorCode::system_failure);
    GTEST_SKIP() << error.what();
  }
  expect_doubled(*context);
}

TEST(Egl, RefusesSoftwareWhenHardwareIsRequested) {
  EglDevice hardware;
  hardware.hardware_only = true;
  try {
    EXPECT_FALSE(open_context(Platform::egl, hardware)->software());
  } catch (const scene::Error& error) {
    EXPECT_EQ(error.code(), scene::ErrorCode::system_failure);
    EXPECT_NE(std::string(error.what()).find("EGL"), std::string::npos);
  }
}

TEST(Egl, RefusesAMissingDevice) {
  EglDevice none;
  none.number = 1000;
  const auto error = error_of([&] { open_context(Platform::egl, none); });
  const std::string words = error.what();  // EGL, or any device, may be missing
  EXPECT_TRUE(words.starts_with("`egl_device` 1000: ") || words.starts_with("EGL: ")) << words;
}

TEST(Library, NamesAMissingLibrary) {
  const auto error = error_of([] { Library("libnothing.so.0", "Nothing", "libnothing0"); });
  EXPECT_EQ(error.code(), scene::ErrorCode::system_failure);
  EXPECT_STREQ(error.what(), "Nothing: libnothing.so.0 cannot be opened; install libnothing0 or use `backend` cpu");
}

TEST(Shader, AMistakeIsFoundByFileAndLine) {
  TESSERA_OSMESA_OR_SKIP(context);
  const auto error = error_of([&] {
    Program(context, {{GL_COMPUTE_SHADER,
                       {{"first.glsl", "float twice(float x) {\n  return 2.0 * x;\n}\n"},
                        {"second.comp", "layout(local_size_x = 1) in;\nvoid main() {\n  undeclared = 1.0;\n}\n"}}}});
  });
  EXPECT_EQ(error.code(), scene::ErrorCode::system_failure);
  EXPECT_NE(std::string(error.what()).find("second.comp:3: "), std::string::npos) << error.what();
}

TEST(Shader, ComplaintsOfSeveralCompilersAreUnderstood) {
  const std::vector<ShaderSource> files = {{"a.glsl", "1\n2\n3\n"}, {"b.glsl", "1\n2\n3\n4"}};
  EXPECT_EQ(first_complaint("0:7(5): error: `x' undeclared\n", files), "b.glsl:2: error: `x' undeclared");
  EXPECT_EQ(first_complaint("0:2(1): warning: unused\n0(3) : error C1503: undefined variable \"x\"\n", files),
            "a.glsl:2: error C1503: undefined variable \"x\"");
  EXPECT_EQ(first_complaint("ERROR: 0:9: 'x' : undeclared identifier\n", files),
            "b.glsl:4: 'x' : undeclared identifier");
  EXPECT_EQ(first_complaint("something else", files), "b.glsl: something else");
}

TEST(Context, ALostContextAndSpentMemoryAreOneLine) {
  TESSERA_OSMESA_OR_SKIP(context);
  context.pretend(GL_CONTEXT_LOST);
  EXPECT_NE(std::string(error_of([&] { context.check("sorting"); }).what()).find("lost while sorting"),
            std::string::npos);
  context.pretend(GL_OUT_OF_MEMORY);
  EXPECT_NE(std::string(error_of([&] { context.check("sorting"); }).what()).find("out of device memory while sorting"),
            std::string::npos);
  context.pretend(GL_NO_ERROR);
  context.check("sorting");
}

TEST(Context, ReportsWhatADeviceRefuses) {
  TESSERA_OSMESA_OR_SKIP(context);
  context.gl().Enable(0xdead);
  const auto error = error_of([&] { context.check("testing"); });
  EXPECT_NE(std::string(error.what()).find("0x0500 while testing"), std::string::npos) << error.what();
}

TEST(Buffer, MoreThanShadersReachIsRefused) {
  TESSERA_OSMESA_OR_SKIP(context);
  Buffer buffer(context, Buffer::Use::device);
  const auto most = static_cast<std::size_t>(context.limit(GL_MAX_SHADER_STORAGE_BLOCK_SIZE));
  EXPECT_EQ(error_of([&] { buffer.reserve(most + 1); }).code(), scene::ErrorCode::system_failure);
  buffer.reserve(100);
  EXPECT_GE(buffer.bytes(), 100u);
}

TEST(Framebuffer, DrawsIntoFloatsOfBothSizes) {
  TESSERA_OSMESA_OR_SKIP(context);
  for (const GLenum format : {GL_RGBA16F, GL_RGBA32F}) {
    Texture texture(context, format);
    EXPECT_TRUE(texture.reserve(8, 4));
    EXPECT_FALSE(texture.reserve(4, 4));
    Framebuffer framebuffer(context);
    framebuffer.attach({&texture});
    framebuffer.clear(0, {0.5f, 0.25f, -2, 1});
    std::vector<float> pixels(8 * 4 * 4);
    context.gl().GetTextureImage(texture.name(), 0, GL_RGBA, GL_FLOAT,
                                 static_cast<GLsizei>(pixels.size() * sizeof(float)), pixels.data());
    EXPECT_EQ(pixels[0], 0.5f);
    EXPECT_EQ(pixels[8 * 4 * 4 - 2], -2.0f);
    context.check("clearing");
  }
}

TEST(StageTimer, StagesAreSpansOnARowOfTheirOwn) {
  TESSERA_OSMESA_OR_SKIP(context);
  scene::Trace trace;
  const std::uint32_t mine = trace.thread_number();
  StageTimer timer(context, &trace);
  timer.begin(3);
  timer.record("sort", 7);
  timer.record("composite");
  context.gl().GetError();
  timer.collect();
  const auto spans = trace.spans();
  ASSERT_EQ(spans.size(), 2u);
  EXPECT_STREQ(spans[0].stage, "sort");
  EXPECT_EQ(spans[0].messages, 7u);
  EXPECT_EQ(spans[0].frame, 3);
  EXPECT_NE(spans[0].thread, mine);
  EXPECT_GE(spans[0].wall_us, 0);
  EXPECT_STREQ(spans[1].stage, "composite");
}

}  // namespace
}  // namespace tessera::gl
