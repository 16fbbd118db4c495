"""Puts the files of pictures into a document."""

import os

MIMES = {b"\x89PNG": "image/png", b"\xff\xd8\xff": "image/jpeg", b"RIFF": "image/webp"}


class ImageEmbedder:
    def __init__(self, document, say):
        self.document, self.say, self.textures = document, say, {}

    def texture(self, path, key):
        """The index of the texture of a file, which goes into the document as it is; None where that is not possible."""
        if path not in self.textures:
            self.textures[path] = self.embed(path, key)
        return self.textures[path]

    def embed(self, path, key):
        try:
            if os.path.exists(path) and not os.path.isfile(path):
                raise OSError(0, "it is no file")  # reading a device or a pipe may never end
            with open(path, "rb") as file:
                content = file.read()
        except (OSError, ValueError) as error:  # a name may hold what no file's name can
            self.say("%s of a material is left out: %s cannot be read (%s)" % (key, path, getattr(error, "strerror", error)))
            return None
        mime = next((mime for magic, mime in MIMES.items() if content.startswith(magic)), None)
        if mime is None:
            self.say("%s of a material is left out: %s is neither PNG nor JPEG nor WebP" % (key, path))
            return None
        image = self.document.append("images", {"mimeType": mime, "bufferView": self.document.view(content)})
        source = {"source": image}
        if mime == "image/webp":
            source = {"extensions": {"EXT_texture_webp": source}}
            self.document.extensions.add("EXT_texture_webp")
            self.document.json["extensionsRequired"] = ["EXT_texture_webp"]
        return self.document.append("textures", source)
