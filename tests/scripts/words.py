"""What programs write to standard error."""
import contextlib
import io


@contextlib.contextmanager
def said():
    with contextlib.redirect_stderr(io.StringIO()) as text:
        yield text
