// SPDX-License-Identifier: BSD-3-Clause
/**
 * Types shared by the page's modules. The server defines the state and the messages (docs/SERVER.md).
 *
 * @typedef {[number, number, number]} Vector
 *
 * @typedef {object} Camera a view in VTK's terms; exactly one of parallel_scale and view_angle
 * @property {Vector} position
 * @property {Vector} focal_point
 * @property {Vector} view_up
 * @property {number} [parallel_scale] orthographic: half the window's height, world units
 * @property {number} [view_angle] perspective: vertical, degrees
 * @property {[number, number]} [clipping_range]
 *
 * @typedef {Record<string, any>} State long option names of `tessera render` without dashes, and their values
 *
 * @typedef {object} Size pixels
 * @property {number} width
 * @property {number} height
 *
 * @typedef {object} Field
 * @property {string} name
 * @property {"point"|"cell"} association
 * @property {number} components
 * @property {string} [type]
 * @property {[number, number]} [range]
 * @property {boolean} [active]
 *
 * @typedef {object} Preset
 * @property {string} name
 * @property {string[]} colors
 * @property {string} [family]
 *
 * @typedef {object} Data the reply of api/data
 * @property {string} file
 * @property {string} format
 * @property {"mesh"|"grid"} kind
 * @property {number} cells
 * @property {number} [tets]
 * @property {[Vector, Vector]} bounds
 * @property {Field[]} fields
 * @property {string|null} field null: only the shape is shown
 * @property {[number, number]} [range] of the field
 * @property {Record<string, number>} [counts] cells read, and those that were left out
 * @property {number} [time_steps]
 * @property {number[]|null} [times]
 * @property {string[]} [blocks]
 * @property {string[]} [surfaces] of the mesh's file, by name
 * @property {string[]} [notes]
 * @property {string[]} [warnings]
 * @property {number} [ranks]
 * @property {number} [threads]
 * @property {string} [tessera]
 * @property {Preset[]} presets
 * @property {string[]} opacities
 * @property {{formats: string[], problem: string|null}} films that can be made, and why others cannot
 * @property {State} defaults
 *
 * @typedef {object} FunctionReply the reply of api/function; colours are sRGB, 0 to 1
 * @property {[number, number]} range
 * @property {string} [name] for display; begins with the preset's name, if any
 * @property {number[][]} colors [value, r, g, b]
 * @property {number[][]} opacities [value, opacity per unit distance]
 * @property {number} unit_distance
 * @property {boolean} log
 * @property {Record<string, any>} json
 * @property {any} paraview
 * @property {string[]} [warnings]
 *
 * @typedef {object} HistogramReply
 * @property {[number, number]} range
 * @property {number[]} counts fractions of the volume
 * @property {boolean} log
 * @property {Record<string, number>} quantiles
 *
 * @typedef {object} FrameHeader
 * @property {"frame"} type
 * @property {number} frame
 * @property {number} number the state's
 * @property {"moving"|"auto"|"exact"} level
 * @property {boolean} [preview]
 * @property {number} width
 * @property {number} height
 * @property {string} mime
 * @property {number} milliseconds
 * @property {number} [encode_ms]
 * @property {number|null} [promised_error]
 * @property {boolean} final
 * @property {Record<string, number>} [stages]
 * @property {string} [field]
 * @property {[number, number]} [range]
 * @property {string[]} [warnings]
 */

export {};
