#pragma once

#include <cstddef>
#include <cstdint>

/// What the project uses of OpenGL 4.5 core, by the names and values of its specification (Khronos, "The OpenGL
/// Graphics System: A Specification", version 4.5, 2017): a build needs no OpenGL headers, whose packages bring a
/// driver.
using GLenum = unsigned int;
using GLbitfield = unsigned int;
using GLuint = unsigned int;
using GLint = int;
using GLsizei = int;
using GLboolean = unsigned char;
using GLubyte = unsigned char;
using GLfloat = float;
using GLint64 = std::int64_t;
using GLuint64 = std::uint64_t;
using GLintptr = std::ptrdiff_t;
using GLsizeiptr = std::ptrdiff_t;
using GLsync = struct GlSync*;

// As int, which compares with signed and unsigned numbers alike.
inline constexpr int GL_ALREADY_SIGNALED = 0x911A;
inline constexpr int GL_BLEND = 0x0BE2;
inline constexpr int GL_BUFFER_UPDATE_BARRIER_BIT = 0x00000200;
inline constexpr int GL_COLOR = 0x1800;
inline constexpr int GL_COLOR_ATTACHMENT0 = 0x8CE0;
inline constexpr int GL_COMPILE_STATUS = 0x8B81;
inline constexpr int GL_COMPUTE_SHADER = 0x91B9;
inline constexpr int GL_CONDITION_SATISFIED = 0x911C;
inline constexpr int GL_CONTEXT_LOST = 0x0507;
inline constexpr int GL_DRAW_FRAMEBUFFER = 0x8CA9;
inline constexpr int GL_FALSE = 0;
inline constexpr int GL_FLOAT = 0x1406;
inline constexpr int GL_FRAGMENT_SHADER = 0x8B30;
inline constexpr int GL_FRAMEBUFFER_COMPLETE = 0x8CD5;
inline constexpr int GL_INFO_LOG_LENGTH = 0x8B84;
inline constexpr int GL_LINK_STATUS = 0x8B82;
inline constexpr int GL_LOSE_CONTEXT_ON_RESET = 0x8252;
inline constexpr int GL_MAJOR_VERSION = 0x821B;
inline constexpr int GL_MAP_COHERENT_BIT = 0x0080;
inline constexpr int GL_MAP_PERSISTENT_BIT = 0x0040;
inline constexpr int GL_MAP_READ_BIT = 0x0001;
inline constexpr int GL_MAP_WRITE_BIT = 0x0002;
inline constexpr int GL_MAX_SHADER_STORAGE_BLOCK_SIZE = 0x90DE;
inline constexpr int GL_MAX_TEXTURE_SIZE = 0x0D33;
inline constexpr int GL_MINOR_VERSION = 0x821C;
inline constexpr int GL_NEAREST = 0x2600;
inline constexpr int GL_NO_ERROR = 0;
inline constexpr int GL_ONE = 1;
inline constexpr int GL_ONE_MINUS_SRC_ALPHA = 0x0303;
inline constexpr int GL_OUT_OF_MEMORY = 0x0505;
inline constexpr int GL_QUERY_RESULT = 0x8866;
inline constexpr int GL_R32F = 0x822E;
inline constexpr int GL_R32UI = 0x8236;
inline constexpr int GL_RED = 0x1903;
inline constexpr int GL_RED_INTEGER = 0x8D94;
inline constexpr int GL_RENDERER = 0x1F01;
inline constexpr int GL_RESET_NOTIFICATION_STRATEGY = 0x8256;
inline constexpr int GL_RG32UI = 0x823C;
inline constexpr int GL_RGBA = 0x1908;
inline constexpr int GL_RGBA16F = 0x881A;
inline constexpr int GL_RGBA32F = 0x8814;
inline constexpr int GL_RG_INTEGER = 0x8228;
inline constexpr int GL_SHADER_STORAGE_BARRIER_BIT = 0x00002000;
inline constexpr int GL_SHADER_STORAGE_BUFFER = 0x90D2;
inline constexpr int GL_SYNC_FLUSH_COMMANDS_BIT = 0x00000001;
inline constexpr int GL_SYNC_GPU_COMMANDS_COMPLETE = 0x9117;
inline constexpr int GL_TEXTURE_2D = 0x0DE1;
inline constexpr int GL_TEXTURE_MAG_FILTER = 0x2800;
inline constexpr int GL_TEXTURE_MIN_FILTER = 0x2801;
inline constexpr int GL_TIMESTAMP = 0x8E28;
inline constexpr int GL_TRIANGLES = 0x0004;
inline constexpr int GL_UNSIGNED_BYTE = 0x1401;
inline constexpr int GL_UNSIGNED_INT = 0x1405;
inline constexpr int GL_VERSION = 0x1F02;
inline constexpr int GL_VERTEX_SHADER = 0x8B31;
inline constexpr int GL_WAIT_FAILED = 0x911D;
inline constexpr GLbitfield GL_ALL_BARRIER_BITS = 0xFFFFFFFF;
