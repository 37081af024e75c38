"""`uncross export`: docs/files.md."""
