"""Rows of advice about files that other libraries read."""

from advice_row import cut, damaged, row

ROWS = []
