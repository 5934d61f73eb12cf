//! A ZIP archive of compressed files (PKWARE's APPNOTE 6.3, sections 4.3 and 4.4): the CSV tables of an experiment in one file.
//!
//! No time is written (the format's zero, 1 January 1980), so equal files give an equal archive. Names are UTF-8. Files and archive are below 4 GiB.

use miniz_oxide::deflate::compress_to_vec;

/// How hard to compress: part of the bytes of every archive. The middle of 1 to 9.
const LEVEL: u8 = 6;

/// The CRC-32 of ISO 3309, reflected, as the format asks for.
fn crc32(bytes: &[u8]) -> u32 {
    let table: [u32; 256] =
        std::array::from_fn(|i| (0..8).fold(i as u32, |c, _| if c & 1 == 1 { 0xedb8_8320 ^ (c >> 1) } else { c >> 1 }));
    !bytes.iter().fold(!0, |c, byte| table[((c ^ u32::from(*byte)) & 0xff) as usize] ^ (c >> 8))
}

/// One file, compressed (RFC 1951).
struct Packed<'a> {
    name: &'a str,
    crc: u32,
    size: usize,
    bytes: Vec<u8>,
}

impl<'a> Packed<'a> {
    fn new(name: &'a str, bytes: &[u8]) -> Self {
        Self { name, crc: crc32(bytes), size: bytes.len(), bytes: compress_to_vec(bytes, LEVEL) }
    }

    /// What the local header and the directory say alike: version, flags (UTF-8), method (deflate), time, date, CRC, sizes, length of the name.
    fn common(&self) -> Vec<u8> {
        let mut head = Vec::with_capacity(26);
        for word in [20_u16, 0x0800, 8, 0, 0x0021] {
            head.extend(word.to_le_bytes());
        }
        for long in [self.crc, self.bytes.len() as u32, self.size as u32] {
            head.extend(long.to_le_bytes());
        }
        head.extend((self.name.len() as u16).to_le_bytes());
        head.extend(0_u16.to_le_bytes());
        head
    }
}

/// The archive of these files, in their order.
pub fn archive(files: &[(String, Vec<u8>)]) -> Vec<u8> {
    let (mut archive, mut directory) = (Vec::new(), Vec::new());
    for (name, bytes) in files {
        let offset = archive.len() as u32;
        let packed = Packed::new(name, bytes);
        let head = packed.common();
        archive.extend(0x0403_4b50_u32.to_le_bytes());
        archive.extend(&head);
        archive.extend(name.as_bytes());
        archive.extend(&packed.bytes);
        directory.extend(0x0201_4b50_u32.to_le_bytes());
        directory.extend(20_u16.to_le_bytes());
        directory.extend(&head);
        // Comment, disk, attributes inside and outside: none.
        directory.extend([0; 10]);
        directory.extend(offset.to_le_bytes());
        directory.extend(name.as_bytes());
    }
    let (start, size, count) = (archive.len() as u32, directory.len() as u32, files.len() as u16);
    archive.extend(directory);
    archive.extend(0x0605_4b50_u32.to_le_bytes());
    archive.extend([0; 4]);
    archive.extend([count.to_le_bytes(), count.to_le_bytes()].concat());
    archive.extend([size.to_le_bytes(), start.to_le_bytes()].concat());
    archive.extend([0; 2]);
    archive
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The check value of CRC-32, and the places that the directory names.
    #[test]
    fn an_archive_is_what_its_directory_says() {
        assert_eq!(crc32(b"123456789"), 0xcbf4_3926);
        let files = [("a.csv".to_owned(), b"x\n1\n".to_vec()), ("φ.csv".to_owned(), vec![])];
        let archive = archive(&files);
        let end = &archive[archive.len() - 22..];
        let long = |at: usize| u32::from_le_bytes([end[at], end[at + 1], end[at + 2], end[at + 3]]) as usize;
        assert_eq!((&end[..4], end[8], end[10]), (&b"PK\x05\x06"[..], 2, 2));
        assert_eq!(long(16) + long(12) + 22, archive.len());
        assert_eq!(&archive[long(16)..long(16) + 4], b"PK\x01\x02");
        assert_eq!(&archive[30..35], b"a.csv");
        let size = u32::from_le_bytes([archive[18], archive[19], archive[20], archive[21]]) as usize;
        let unpacked = miniz_oxide::inflate::decompress_to_vec(&archive[35..35 + size]);
        assert_eq!(unpacked.ok().as_deref(), Some(&b"x\n1\n"[..]));
    }
}
