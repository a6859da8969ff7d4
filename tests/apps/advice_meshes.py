"""Rows of advice about files of meshes that the library reads itself."""

from advice_row import cut, damaged, row

R = "render m.vtu -o a.png --size 16x16 "
V = "render v.vti -o a.png --size 16x16 "

ROWS = [
    # meshes
]
