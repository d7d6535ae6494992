//! What every page has: head, style, title.

use crate::report::rich::escaped;
use crate::report::svg;

/// By this a file is known as one of ours, which may be written over.
pub(super) const MARK: &str = "<meta name=\"generator\" content=\"remainder\"/>";

const STYLE: &str = include_str!("page.css");

/// A whole page. XML syntax throughout, so that any XML parser can check it.
pub(super) fn page(title: &str, body: &str) -> String {
    format!(
        "<!DOCTYPE html>\n<html lang=\"en\" xmlns=\"http://www.w3.org/1999/xhtml\"><head><meta charset=\"utf-8\"/>\
         <meta name=\"viewport\" content=\"width=device-width, initial-scale=1\"/>{MARK}\n<title>{}</title>\n\
         <style>{STYLE}{}</style></head>\n<body>{body}</body></html>\n",
        escaped(title),
        svg::STYLE
    )
}
