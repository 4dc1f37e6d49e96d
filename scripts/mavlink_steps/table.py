"""A table (CSV) that can be read whenever the program that writes it is killed."""
import os


def fits_a_cell(text):
    """Cells have no quotes around them."""
    return text == text.strip() and not any(mark in text for mark in ',"\r\n')


class Table:
    """A new file, so that no flight is mixed with another. Throws OSError."""

    def __init__(self, path, columns):
        self.path = path
        try:
            self._file = open(path, "xb", buffering=0)
        except FileExistsError:
            raise OSError(f"{path} is there already: give each flight a table of its own") from None
        self._size = 0
        self.append(columns)

    def __enter__(self):
        return self

    def __exit__(self, *_):
        self._file.close()

    def append(self, cells):
        """A row, or where the disk has no room for it, nothing. Throws OSError."""
        row = os.fsencode(",".join(cells) + "\n")
        if self._file.write(row) < len(row):
            self._file.seek(self._size)
            self._file.truncate()
            raise OSError("the disk has no room for the table")
        self._size += len(row)
