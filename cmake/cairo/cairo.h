#pragma once

// What the project calls of Cairo's C interface (version 1.16; libcairo.so.2), by its own names and values: a build
// needs the library alone, not the package of its headers, which brings X11's, GLib's and Python.
extern "C" {

typedef struct _cairo cairo_t;                            // NOLINT: theirs, as all names here
typedef struct _cairo_surface cairo_surface_t;            // NOLINT
typedef struct _cairo_font_face cairo_font_face_t;        // NOLINT
typedef struct _cairo_scaled_font cairo_scaled_font_t;    // NOLINT
typedef struct _cairo_font_options cairo_font_options_t;  // NOLINT

// Constants that are used; the others' numbers are allowed for.
enum cairo_status_t : int { CAIRO_STATUS_SUCCESS = 0 };
enum cairo_antialias_t : int { CAIRO_ANTIALIAS_GRAY = 2 };
enum cairo_font_slant_t : int { CAIRO_FONT_SLANT_NORMAL = 0 };
enum cairo_font_weight_t : int { CAIRO_FONT_WEIGHT_NORMAL = 0 };
enum cairo_font_type_t : int { CAIRO_FONT_TYPE_USER = 4 };
enum cairo_format_t : int { CAIRO_FORMAT_RGB24 = 1, CAIRO_FORMAT_A8 = 2 };
enum cairo_hint_metrics_t : int { CAIRO_HINT_METRICS_OFF = 1 };
enum cairo_hint_style_t : int { CAIRO_HINT_STYLE_NONE = 1 };
enum cairo_line_cap_t : int { CAIRO_LINE_CAP_BUTT = 0, CAIRO_LINE_CAP_SQUARE = 2 };
enum cairo_line_join_t : int { CAIRO_LINE_JOIN_ROUND = 1 };

struct cairo_font_extents_t {
  double ascent, descent, height, max_x_advance, max_y_advance;
};
struct cairo_text_extents_t {
  double x_bearing, y_bearing, width, height, x_advance, y_advance;
};
using cairo_write_func_t = cairo_status_t (*)(void* closure, const unsigned char* bytes, unsigned int length);

cairo_t* cairo_create(cairo_surface_t* target);
void cairo_destroy(cairo_t* cairo);
void cairo_save(cairo_t* cairo);
void cairo_restore(cairo_t* cairo);
cairo_status_t cairo_status(cairo_t* cairo);
const char* cairo_status_to_string(cairo_status_t status);

void cairo_translate(cairo_t* cairo, double x, double y);
void cairo_scale(cairo_t* cairo, double x, double y);
void cairo_rotate(cairo_t* cairo, double angle);
void cairo_set_source_rgb(cairo_t* cairo, double red, double green, double blue);
void cairo_set_line_width(cairo_t* cairo, double width);
void cairo_set_line_cap(cairo_t* cairo, cairo_line_cap_t cap);
void cairo_set_line_join(cairo_t* cairo, cairo_line_join_t join);

void cairo_new_path(cairo_t* cairo);
void cairo_move_to(cairo_t* cairo, double x, double y);
void cairo_line_to(cairo_t* cairo, double x, double y);
void cairo_arc(cairo_t* cairo, double x, double y, double radius, double first_angle, double last_angle);
void cairo_rectangle(cairo_t* cairo, double x, double y, double width, double height);
void cairo_close_path(cairo_t* cairo);
void cairo_text_path(cairo_t* cairo, const char* utf8);
void cairo_stroke(cairo_t* cairo);
void cairo_stroke_preserve(cairo_t* cairo);
void cairo_fill(cairo_t* cairo);
void cairo_show_text(cairo_t* cairo, const char* utf8);

cairo_font_face_t* cairo_toy_font_face_create(const char* family, cairo_font_slant_t slant, cairo_font_weight_t weight);
void cairo_font_face_destroy(cairo_font_face_t* face);
void cairo_select_font_face(cairo_t* cairo, const char* family, cairo_font_slant_t slant, cairo_font_weight_t weight);
void cairo_set_font_face(cairo_t* cairo, cairo_font_face_t* face);
void cairo_set_font_size(cairo_t* cairo, double size);
cairo_scaled_font_t* cairo_get_scaled_font(cairo_t* cairo);
cairo_font_type_t cairo_scaled_font_get_type(cairo_scaled_font_t* font);
cairo_font_options_t* cairo_font_options_create();
void cairo_font_options_destroy(cairo_font_options_t* options);
void cairo_font_options_set_antialias(cairo_font_options_t* options, cairo_antialias_t antialias);
void cairo_font_options_set_hint_style(cairo_font_options_t* options, cairo_hint_style_t style);
void cairo_font_options_set_hint_metrics(cairo_font_options_t* options, cairo_hint_metrics_t metrics);
void cairo_set_font_options(cairo_t* cairo, const cairo_font_options_t* options);
void cairo_font_extents(cairo_t* cairo, cairo_font_extents_t* extents);
void cairo_text_extents(cairo_t* cairo, const char* utf8, cairo_text_extents_t* extents);

cairo_surface_t* cairo_image_surface_create(cairo_format_t format, int width, int height);
cairo_surface_t* cairo_svg_surface_create_for_stream(cairo_write_func_t write, void* closure, double width_points,
                                                     double height_points);
unsigned char* cairo_image_surface_get_data(cairo_surface_t* surface);
int cairo_image_surface_get_stride(cairo_surface_t* surface);
cairo_status_t cairo_surface_status(cairo_surface_t* surface);
void cairo_surface_flush(cairo_surface_t* surface);
void cairo_surface_mark_dirty(cairo_surface_t* surface);
void cairo_surface_finish(cairo_surface_t* surface);
void cairo_surface_destroy(cairo_surface_t* surface);
cairo_status_t cairo_surface_write_to_png_stream(cairo_surface_t* surface, cairo_write_func_t write, void* closure);
}
