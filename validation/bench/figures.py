def draw(rows, out):
    pass
